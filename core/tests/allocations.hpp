#pragma once
// Counts every allocation of this program, so that a test can show that there was none.

namespace alula_test {
long allocations();
}

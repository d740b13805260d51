"""The excerpt that the README shows of the demo; alone, because the demo takes the longest."""

from __future__ import annotations

from pathlib import Path

from docs.test_commands import ROOT, blocks, run


def test_readme_excerpt_is_what_the_demo_prints(tmp_path: Path) -> None:
    """Name, truth and verdict by the letter; value and error as another processor may round."""
    (shown,) = [b.splitlines() for b in blocks("README.md", "") if b.startswith("parameter")]
    done = run(["python", str(ROOT / "examples/demo/demo.py"), "--folder", str(tmp_path)], ROOT)
    assert done.code == 0, done.err
    printed = {line.split()[0]: line.split() for line in done.out.splitlines() if line.strip()}
    assert shown[0].split() == printed["parameter"]
    for line in shown[1:]:
        words = line.split()
        now = printed[words[0]]
        assert words[-2:] == now[-2:]
        error = float(words[2])
        # Half a standard error: the page stays true as long as it tells the same story.
        assert abs(float(words[1]) - float(now[1])) < 0.5 * error
        assert 0.5 < float(now[2]) / error < 2.0

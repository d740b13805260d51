#pragma once
// The linear systems of the lattice: no flow through the panels at their control points.
//
// A lattice that is its own mirror image has two systems of half the size, for symmetric and for
// antisymmetric circulation; panels in the plane of symmetry take part in the second only. Without
// symmetry there is one full system, kept as the second.
#include <Eigen/LU>
#include <memory>

#include "alula/host/vortex_lattice_influence.hpp"

namespace alula::lattice {

// A square matrix, factorized where it lies.
class Factorized {
 public:
  explicit Factorized(Eigen::MatrixXd& A) : lu_(A) {}

  // The columns' first numbers, as many as the matrix has rows, become those of the solutions.
  void solve(const std::vector<Values*>& columns) const {
    const Eigen::Index n = lu_.rows();
    Eigen::MatrixXd x(n, columns.size());
    for (std::size_t k = 0; k < columns.size(); ++k) std::copy_n(columns[k]->data(), n, &x(0, k));
    x = lu_.solve(x);
    for (std::size_t k = 0; k < columns.size(); ++k) std::copy_n(&x(0, k), n, columns[k]->data());
  }

 private:
  Eigen::PartialPivLU<Eigen::Ref<Eigen::MatrixXd>> lu_;
};

class Systems {
 public:
  Systems(const Lattice& lattice, const WindLattice& wind) : lattice_(lattice) {
    symmetric_.setZero(lattice.right, lattice.right);
    other_.resize(lattice.solved(), lattice.solved());
    for (int i = 0; i < lattice.solved(); i += kTile) assemble(wind, i);
    if (lattice.right > 0) symmetric_lu_ = std::make_unique<Factorized>(symmetric_);
    other_lu_ = std::make_unique<Factorized>(other_);
  }

  // Circulations of all panels for the velocities through the solved panels' control points that
  // they have to stop. parity, by column: 1 symmetric, -1 antisymmetric or without symmetry.
  Columns circulation(Columns through, const std::vector<int>& parity) const {
    const int right = lattice_.right, solved = lattice_.solved();
    std::vector<Values*> symmetric, other;
    for (std::size_t k = 0; k < through.size(); ++k) {
      for (double& v : through[k]) v = -v;
      through[k].resize(lattice_.panels());
      (parity[k] > 0 && right > 0 ? symmetric : other).push_back(&through[k]);
    }
    if (!symmetric.empty()) symmetric_lu_->solve(symmetric);
    if (!other.empty()) other_lu_->solve(other);
    for (Values* g : symmetric) std::fill(g->begin() + right, g->begin() + solved, 0.0);
    for (std::size_t k = 0; k < through.size(); ++k)
      for (int i = 0; i < right; ++i) through[k][lattice_.mirror[i]] = parity[k] * through[k][i];
    return through;
  }

 private:
  void assemble(const WindLattice& wind, int begin) {
    const int right = lattice_.right, solved = lattice_.solved();
    const Tile tile(wind.control, wind.surface, begin, solved);
    const int both = std::clamp(right - begin, 0, tile.count);  // rows that are in both systems
    Field normal{};
    for (int i = 0; i < tile.count; ++i) normal.set(i, wind.normal[begin + i]);
    alignas(64) double through[kTile];
    for (Blocks b(lattice_, wind, tile); b.next();)
      for (int k = 0; k < b.count; ++k) {
        for (int i = 0; i < tile.padded; i += kLanes)
          dot(b.velocity[k].load(i), normal.load(i)).store(through + i);
        // Column of a left panel: that of its image.
        const int panel = b.panel + k, column = panel < solved ? panel : image_[panel - solved];
        double* a = &other_(begin, column);
        if (panel < solved)
          std::copy_n(through, tile.count, a);
        else
          for (int i = 0; i < tile.count; ++i) a[i] -= through[i];
        if (column >= right || both == 0) continue;
        a = &symmetric_(begin, column);
        for (int i = 0; i < both; ++i) a[i] += through[i];
      }
  }

  static std::vector<int> images(const Lattice& lattice) {
    std::vector<int> out(lattice.panels() - lattice.solved());
    for (int i = 0; i < lattice.right; ++i) out[lattice.mirror[i] - lattice.solved()] = i;
    return out;
  }

  const Lattice& lattice_;
  std::vector<int> image_ = images(lattice_);
  Eigen::MatrixXd symmetric_, other_;
  std::unique_ptr<Factorized> symmetric_lu_, other_lu_;
};

}  // namespace alula::lattice

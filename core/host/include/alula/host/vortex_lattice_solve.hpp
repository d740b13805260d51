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

class Systems {
 public:
  Systems(const Lattice& lattice, const WindLattice& wind) : lattice_(lattice) {
    symmetric_.setZero(lattice.right, lattice.right);
    other_.resize(lattice.solved(), lattice.solved());
    for (int i = 0; i < lattice.solved(); i += kTile) assemble(wind, i);
    if (lattice.right > 0) symmetric_lu_ = std::make_unique<InPlace>(symmetric_);
    other_lu_ = std::make_unique<InPlace>(other_);
  }

  // Circulation of all panels for the velocity through the solved panels' control points that it
  // has to stop. parity: 1 symmetric, -1 antisymmetric or without symmetry.
  VectorXd circulation(const VectorXd& through, int parity) const {
    const int right = lattice_.right, solved = lattice_.solved();
    VectorXd out = VectorXd::Zero(lattice_.panels());
    if (parity > 0 && right > 0)
      out.head(right) = symmetric_lu_->solve(-through.head(right));
    else
      out.head(solved) = other_lu_->solve(-through);
    for (int i = 0; i < right; ++i)
      out[lattice_.mirror[static_cast<std::size_t>(i)]] = parity * out[i];
    return out;
  }

 private:
  using InPlace = Eigen::PartialPivLU<Eigen::Ref<MatrixXd>>;

  void assemble(const WindLattice& wind, int begin) {
    const int right = lattice_.right, solved = lattice_.solved();
    const Tile tile(wind.control, wind.surface, begin, std::min(begin + kTile, solved));
    const int both = std::clamp(right - begin, 0, tile.count);  // rows that are in both systems
    const Eigen::ArrayXd nx = wind.normal.row(0).segment(begin, tile.count),
                         ny = wind.normal.row(1).segment(begin, tile.count),
                         nz = wind.normal.row(2).segment(begin, tile.count);
    // Column of a left panel: that of its image.
    Eigen::ArrayXd normal(tile.count);
    induce(lattice_, wind, tile, [&](int first, int n, const Block& block) {
      for (int k = 0; k < n; ++k) {
        const int panel = first + k;
        normal = block.col(k).segment(0, tile.count).array() * nx +
                 block.col(k).segment(kTile, tile.count).array() * ny +
                 block.col(k).segment(2 * kTile, tile.count).array() * nz;
        if (panel < solved) {
          other_.col(panel).segment(begin, tile.count) = normal;
          if (panel < right && both > 0)
            symmetric_.col(panel).segment(begin, both) += normal.head(both).matrix();
        } else {
          const int image = image_[static_cast<std::size_t>(panel - solved)];
          other_.col(image).segment(begin, tile.count) -= normal.matrix();
          if (both > 0) symmetric_.col(image).segment(begin, both) += normal.head(both).matrix();
        }
      }
    });
  }

  static std::vector<int> images(const Lattice& lattice) {
    std::vector<int> out(static_cast<std::size_t>(lattice.panels() - lattice.solved()));
    for (int i = 0; i < lattice.right; ++i)
      out[static_cast<std::size_t>(lattice.mirror[static_cast<std::size_t>(i)] -
                                   lattice.solved())] = i;
    return out;
  }

  const Lattice& lattice_;
  std::vector<int> image_ = images(lattice_);
  MatrixXd symmetric_, other_;
  std::unique_ptr<InPlace> symmetric_lu_, other_lu_;
};

}  // namespace alula::lattice

/// What the backends on the CPU share: threads, kept maps, the error.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "zbuffer/detail/view.hpp"

namespace rejoin::zbuffer::detail {

enum class Side { A, B };

/// A scorer whose backend draws one map at a time.
///
/// A batch is cut into a few lanes of consecutive poses; a lane keeps the last two maps of each fragment, so
/// that a fragment whose parameters did not change (or went back to those before a rejected move) is not
/// drawn again. Maps depend on nothing but their projection, so neither lanes nor threads show in the scores.
class MapScorer : public Scorer {
 public:
  /// \param options  completed
  explicit MapScorer(const ViewOptions& options) : options_(options) {}

  void score(std::span<const ViewPair> poses, std::span<PairScore> scores) final;
  std::pair<DepthMap, DepthMap> depth_maps(const ViewPair& pose) final;

 protected:
  const ViewOptions& options() const { return options_; }

  /// Draws a fragment into resolution x resolution depths that are NaN everywhere.  Thread-safe.
  virtual void render(Side side, const Projection& projection, std::span<float> depth) const = 0;

 private:
  struct Slot {
    Projection projection;
    std::vector<float> depth;  ///< empty until first used
    std::uint64_t last_use = 0;
  };
  struct Lane {
    std::array<std::array<Slot, 2>, 2> slots;  ///< per side
    std::uint64_t clock = 0;
  };

  const float* map_of(Side side, const Projection& projection, Lane& lane) const;
  PairScore score_one(const ViewPair& pose, Lane& lane) const;
  DepthMap depth_map(Side side, const Projection& projection) const;

  ViewOptions options_;
  std::vector<Lane> lanes_;
};

}  // namespace rejoin::zbuffer::detail

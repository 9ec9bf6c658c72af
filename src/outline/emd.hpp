/// Joins by the longest common boundary whose earth mover's cost is small.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "outline/matcher.hpp"

namespace rejoin::outline {

struct EmdOptions {
  double moment_length_weight = 0.1;    ///< lambda_1 of eq. (1) while capturing alignment moments
  double moment_property_weight = 0.9;  ///< lambda_2 of eq. (1) there
  double length_weight = 0.5;           ///< lambda_1 of the real cost
  double property_weight = 0.5;         ///< lambda_2 of the real cost
  double colour_share = 0.0;            ///< of colour in the property, 0..1; the rest is curvature
  double epsilon = 0.003;               ///< largest cost, share of the length of both borders
  std::vector<double> samples = {640.0, 240.0, 100.0};  ///< of a border of median length, a number a scale
  std::size_t moments = 24;                             ///< starting points a pair and scale
  std::size_t candidates = 5;                           ///< kept a pair
};

/// \source zhang 2016, sections 3 and 4.1 to 4.3
std::unique_ptr<Matcher> make_emd(const EmdOptions& options = {});

/// The same search with the Frechet distance of the aligned stretches, at most epsilon times the mean border, instead of
/// the earth mover's cost.
/// \source zhang 2016, section 5.1 (the comparison)
std::unique_ptr<Matcher> make_frechet(const EmdOptions& options = {});

}  // namespace rejoin::outline

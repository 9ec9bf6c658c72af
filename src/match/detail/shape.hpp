/// What shape there is in values and in points.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace rejoin::match::detail {

/// 1.48 times the median absolute deviation: the standard deviation of what is not outliers.  \pre not empty
double robust_deviation(std::vector<double> values);

/// Heights of points along `normal` above the quadric that fits them best; with more rounds, that fits most of them best.
/// \param normal  unit
std::vector<double> heights_above_quadric(const std::vector<glm::dvec3>& points, const glm::dvec3& normal,
                                          int rounds);

/// Squared robust deviations of values at points from their means over the surroundings of each radius, and over all.
/// \param values  as many as points
/// \param radii   ascending
/// \return one more than radii
std::vector<double> variances_by_scale(const std::vector<glm::dvec3>& points,
                                       const std::vector<double>& values, std::span<const double> radii);

/// Mean of points.
glm::dvec3 middle(const std::vector<glm::dvec3>& points);

}  // namespace rejoin::match::detail

#include <Eigen/Dense>
#include <algorithm>
#include <utility>

#include "mesh/detail/facet_table.hpp"
#include "mesh/facets.hpp"

namespace rejoin::mesh {
namespace {

using Members = std::vector<std::uint32_t>;

/// Parts samples at the median of their places along their longest extent.
std::pair<Members, Members> halves(const Members& samples, const std::vector<glm::vec3>& points) {
  const auto place = [&](std::uint32_t i) {
    return Eigen::Vector3d(static_cast<double>(points[i].x), static_cast<double>(points[i].y),
                           static_cast<double>(points[i].z));
  };
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  for (const auto i : samples) centre += place(i);
  centre /= static_cast<double>(samples.size());
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const auto i : samples) spread += (place(i) - centre) * (place(i) - centre).transpose();
  const Eigen::Vector3d longest =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvectors().col(2);
  std::vector<std::pair<double, std::uint32_t>> along;
  for (const auto i : samples) along.emplace_back(longest.dot(place(i) - centre), i);
  std::sort(along.begin(), along.end());
  std::pair<Members, Members> parts;
  for (std::size_t k = 0; k < along.size(); ++k)
    (2 * k < along.size() ? parts.first : parts.second).push_back(along[k].second);
  return parts;
}

}  // namespace

Cut quarters(const Segmentation& segmentation, const Cut& cut, const std::vector<int>& facets) {
  const std::vector<glm::vec3>& points = segmentation.samples.points;
  std::vector<Members> members;
  for (const int f : facets) {
    const auto [near, far] = halves(cut.facets[static_cast<std::size_t>(f)].samples, points);
    for (const Members* half : {&near, &far}) {
      if (half->empty()) continue;
      auto [first, second] = halves(*half, points);
      for (Members* quarter : {&first, &second}) {
        if (!quarter->empty()) members.push_back(std::move(*quarter));
      }
    }
  }
  return detail::cut_into(segmentation, std::move(members));
}

}  // namespace rejoin::mesh

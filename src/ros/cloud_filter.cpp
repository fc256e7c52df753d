#include "spelunk/ros/cloud_filter.h"

#include <pcl/filters/radius_outlier_removal.h>
#include <pcl/filters/statistical_outlier_removal.h>
#include <pcl/filters/voxel_grid.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

namespace spelunk::bridge {
namespace {

using Cloud = pcl::PointCloud<pcl::PointXYZ>;

Cloud::Ptr toPcl(const std::vector<Eigen::Vector3f>& points) {
  const Cloud::Ptr cloud(new Cloud);
  cloud->reserve(points.size());
  for (const Eigen::Vector3f& point : points) cloud->emplace_back(point.x(), point.y(), point.z());
  return cloud;
}

std::vector<Eigen::Vector3f> fromPcl(const Cloud& cloud) {
  std::vector<Eigen::Vector3f> points;
  points.reserve(cloud.size());
  for (const pcl::PointXYZ& point : cloud) points.emplace_back(point.x, point.y, point.z);
  return points;
}

template <class Filter>
Cloud::Ptr applied(Filter& filter, const Cloud::Ptr& cloud) {
  const Cloud::Ptr result(new Cloud);
  filter.setInputCloud(cloud);
  filter.filter(*result);
  return result;
}

Cloud::Ptr withoutOutliers(const Cloud::Ptr& cloud, const CloudParams& params) {
  if (params.outlier_filter == "statistical") {
    pcl::StatisticalOutlierRemoval<pcl::PointXYZ> filter;
    filter.setMeanK(params.outlier_neighbours);
    filter.setStddevMulThresh(params.outlier_stddevs);
    return applied(filter, cloud);
  }
  pcl::RadiusOutlierRemoval<pcl::PointXYZ> filter;
  filter.setRadiusSearch(params.outlier_radius_m);
  filter.setMinNeighborsInRadius(params.outlier_neighbours);
  return applied(filter, cloud);
}

Cloud::Ptr onePointAVoxel(const Cloud::Ptr& cloud, double size_m) {
  const auto size = static_cast<float>(size_m);
  pcl::VoxelGrid<pcl::PointXYZ> filter;
  filter.setLeafSize(size, size, size);
  return applied(filter, cloud);
}

}  // namespace

std::vector<std::string> CloudParams::problems() const {
  if (outlier_filter == "none" || outlier_filter == "statistical" || outlier_filter == "radius")
    return {};
  return {"cloud.outlier_filter = '" + outlier_filter + "': must be none, statistical or radius"};
}

std::vector<Eigen::Vector3f> filtered(std::vector<Eigen::Vector3f> points,
                                      const CloudParams& params) {
  const bool removes_outliers = params.outlier_filter != "none";
  if (points.empty() || (!removes_outliers && params.voxel_size_m <= 0.0)) return points;
  Cloud::Ptr cloud = toPcl(points);
  if (removes_outliers) cloud = withoutOutliers(cloud, params);
  if (params.voxel_size_m > 0.0) cloud = onePointAVoxel(cloud, params.voxel_size_m);
  return fromPcl(*cloud);
}

}  // namespace spelunk::bridge

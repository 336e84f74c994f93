#include "assets/thumbnail.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "image/png_file.h"
#include "rays/ray_scene.h"
#include "spec/frame_spec.h"

namespace seedframe {
namespace {

using Eigen::Vector3d;

constexpr int kSubpixels = 4;  // both ways

/// Scene-linear; the first is plain grey, and what comes after the last begins anew.
constexpr std::array<Rgb, 6> kSlotTints = {{{0.55, 0.55, 0.56},
                                            {0.58, 0.40, 0.26},
                                            {0.28, 0.42, 0.58},
                                            {0.36, 0.52, 0.34},
                                            {0.56, 0.34, 0.40},
                                            {0.54, 0.50, 0.28}}};

/// The camera's frame from the mesh's: x right, y up, z towards the viewer.
Eigen::Matrix3d view() {
  const Vector3d back = Vector3d(0.55, -0.72, 0.45).normalized();
  const Vector3d right = Vector3d::UnitZ().cross(back).normalized();
  Eigen::Matrix3d rotation;
  rotation << right.transpose(), back.cross(right).transpose(), back.transpose();
  return rotation;
}

double srgb(double linear) {
  const double value = std::clamp(linear, 0.0, 1.0);
  return value <= 0.0031308 ? 12.92 * value : 1.055 * std::pow(value, 1.0 / 2.4) - 0.055;
}

/// A key light from the upper left, a weak one from the right, and light from above everywhere.
double shade(const std::array<float, 3>& n) {
  const Vector3d normal(n[0], n[1], n[2]);
  const double key = std::max(0.0, normal.dot(Vector3d(-0.5, 0.6, 0.62)));
  const double fill = std::max(0.0, normal.dot(Vector3d(0.8, 0.1, 0.59)));
  return 0.22 + 0.12 * normal.y() + 0.72 * key + 0.18 * fill;
}

/// Turned to the view, scaled to fill the square from -1 to 1, and put into its middle.
Eigen::Affine3d fitted(const Mesh& mesh, double distance) {
  const Eigen::Matrix3d turn = view();
  Vector3d low = Vector3d::Constant(std::numeric_limits<double>::infinity());
  Vector3d high = -low;
  for (const auto& p : mesh.positions) {
    const Vector3d seen = turn * Vector3d(p[0], p[1], p[2]);
    low = low.cwiseMin(seen);
    high = high.cwiseMax(seen);
  }
  const double half = std::max(0.5 * (high - low).head<2>().maxCoeff(), 1e-12);
  Eigen::Affine3d camera_from_object = Eigen::Affine3d::Identity();
  camera_from_object.translate(Vector3d(0, 0, -distance));
  camera_from_object.scale(1.0 / half);
  camera_from_object.translate(-0.5 * (low + high));
  camera_from_object.rotate(turn);
  return camera_from_object;
}

/// The triangles of one slot with the vertices that they need. `number` has an entry for each
/// vertex of the mesh, kUnused between the calls.
constexpr std::uint32_t kUnused = std::numeric_limits<std::uint32_t>::max();
Mesh part_of(const Mesh& mesh, const std::vector<std::size_t>& triangles,
             std::vector<std::uint32_t>& number) {
  Mesh part;
  part.smooth_angle_rad = mesh.smooth_angle_rad;
  for (const std::size_t t : triangles) {
    part.triangles.push_back(mesh.triangles[t]);
    for (std::uint32_t& vertex : part.triangles.back()) {
      if (number[vertex] == kUnused) {
        number[vertex] = static_cast<std::uint32_t>(part.positions.size());
        part.positions.push_back(mesh.positions[vertex]);
      }
      vertex = number[vertex];
    }
  }
  for (const std::size_t t : triangles) {
    for (const std::uint32_t vertex : mesh.triangles[t]) number[vertex] = kUnused;
  }
  return part;
}

/// A mesh for each slot that has triangles, so that a hit tells the slot. `slots` gets their
/// numbers.
std::vector<RayInstance> slots_of(const Mesh& mesh, const Eigen::Affine3d& camera_from_object,
                                  std::vector<std::size_t>& slots) {
  std::vector<std::vector<std::size_t>> triangles(mesh.slot_names.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    triangles[mesh.triangle_slots[t]].push_back(t);
  }
  std::vector<RayInstance> instances;
  std::vector<std::uint32_t> number(mesh.positions.size(), kUnused);
  for (std::size_t slot = 0; slot < triangles.size(); ++slot) {
    if (triangles[slot].empty()) continue;
    instances.push_back({std::make_shared<const RayMesh>(part_of(mesh, triangles[slot], number)),
                         camera_from_object, true});
    slots.push_back(slot);
  }
  return instances;
}

}  // namespace

Image<std::uint8_t> thumbnail(const Mesh& mesh, int side_px) {
  // So far away that parallel lines look parallel.
  constexpr double kDistance = 30.0;
  const int side = kSubpixels * side_px;
  const double focal = 0.46 * side * kDistance;
  const double middle = 0.5 * (side - 1);
  std::vector<std::size_t> slots;
  const RayScene scene({side, side, {focal, focal}, {middle, middle}, 0.1, 100.0},
                       slots_of(mesh, fitted(mesh, kDistance), slots));
  const RayImage traced = scene.trace({.normals = true});
  Image<std::uint8_t> picture(side_px, side_px, 3);
  for (int y = 0; y < side_px; ++y) {
    for (int x = 0; x < side_px; ++x) {
      Rgb sum{};
      for (int sub = 0; sub < kSubpixels * kSubpixels; ++sub) {
        const std::size_t at =
            traced.index(kSubpixels * x + sub % kSubpixels, kSubpixels * y + sub / kSubpixels);
        const int hit = traced.instance[at];
        for (std::size_t c = 0; c < 3; ++c) {
          if (hit < 0) {
            sum[c] += 1.0;
            continue;
          }
          const std::size_t slot = slots[static_cast<std::size_t>(hit)];
          sum[c] += kSlotTints[slot % kSlotTints.size()][c] * shade(traced.normals[at]);
        }
      }
      for (int c = 0; c < 3; ++c) {
        const double mean = sum[static_cast<std::size_t>(c)] / (kSubpixels * kSubpixels);
        picture.at(y, x, c) = static_cast<std::uint8_t>(std::lround(255.0 * srgb(mean)));
      }
    }
  }
  return picture;
}

std::string thumbnail_png(const Mesh& mesh) {
  constexpr int kSide = 256;
  return encode_png(thumbnail(mesh, kSide));
}

}  // namespace seedframe

#include "rays/ray_mesh.h"

#include <algorithm>
#include <atomic>
#include <new>

#include "mesh/corner_normals.h"
#include "rays/embree_device.h"

namespace seedframe {
namespace {

std::atomic<std::size_t> g_embree_bytes = 0;

bool count_bytes(void*, ssize_t bytes, bool) {
  g_embree_bytes += static_cast<std::size_t>(bytes);  // a negative number of them is subtracted
  return true;
}

template <class T>
T* new_buffer(RTCGeometry geometry, RTCBufferType type, RTCFormat format, std::size_t count) {
  void* buffer = rtcSetNewGeometryBuffer(geometry, type, 0, format, sizeof(T), count);
  if (buffer == nullptr) throw std::bad_alloc();
  return static_cast<T*>(buffer);
}

}  // namespace

RTCDevice embree_device() {
  static const RTCDevice shared = [] {
    // AVX-512 and AVX2 round differently; the lower of the two is the same everywhere.
    RTCDevice made = rtcNewDevice("threads=1,set_affinity=0,max_isa=avx2");
    rtcSetDeviceMemoryMonitorFunction(made, count_bytes, nullptr);
    return made;
  }();
  return shared;
}

RTCScene new_embree_scene() {
  const RTCScene scene = rtcNewScene(embree_device());
  rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
  return scene;
}

void commit_scene(RTCScene scene) {
  rtcCommitScene(scene);
  if (rtcGetDeviceError(embree_device()) != RTC_ERROR_NONE) throw std::bad_alloc();
}

RayMesh::RayMesh(const Mesh& mesh)
    : tree_(std::make_unique<Tree>()),
      box_(bounding_box(mesh)),
      smooth_angle_rad_(mesh.smooth_angle_rad) {
  const RTCGeometry geometry = rtcNewGeometry(embree_device(), RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* points = new_buffer<std::array<float, 3>>(geometry, RTC_BUFFER_TYPE_VERTEX,
                                                  RTC_FORMAT_FLOAT3, mesh.positions.size());
  std::copy(mesh.positions.begin(), mesh.positions.end(), points);
  auto* triangles = new_buffer<std::array<std::uint32_t, 3>>(
      geometry, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, mesh.triangles.size());
  std::copy(mesh.triangles.begin(), mesh.triangles.end(), triangles);
  tree_->positions = points;
  tree_->triangles = triangles;
  tree_->vertex_count = mesh.positions.size();
  tree_->triangle_count = mesh.triangles.size();
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(tree_->scene, geometry);
  rtcReleaseGeometry(geometry);
  commit_scene(tree_->scene);
}

RayMesh::~RayMesh() = default;

std::size_t RayMesh::triangle_count() const { return tree_->triangle_count; }

const std::vector<std::array<float, 3>>& RayMesh::normals() const {
  std::call_once(normals_made_, [this] {
    normals_ = corner_normals({tree_->positions, tree_->vertex_count},
                              {tree_->triangles, tree_->triangle_count}, smooth_angle_rad_);
  });
  return normals_;
}

const std::vector<MeshEdge>& RayMesh::edges() const {
  std::call_once(edges_made_, [this] {
    edges_ = edges_of_closed_mesh({tree_->positions, tree_->vertex_count},
                                  {tree_->triangles, tree_->triangle_count});
  });
  return edges_;
}

std::size_t ray_tracing_bytes() { return g_embree_bytes; }

std::string ray_tracing_version() {
  const auto version = rtcGetDeviceProperty(embree_device(), RTC_DEVICE_PROPERTY_VERSION);
  return std::to_string(version / 10000) + "." + std::to_string(version / 100 % 100) + "." +
         std::to_string(version % 100);
}

std::string ray_tracing_isa() {
  // Embree tells only which packets run natively on the chosen instruction set.
  const RTCDevice device = embree_device();
  if (rtcGetDeviceProperty(device, RTC_DEVICE_PROPERTY_NATIVE_RAY8_SUPPORTED) != 0) {
    return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") ? "avx2" : "avx";
  }
  return __builtin_cpu_supports("sse4.2") ? "sse4.2" : "sse2";
}

}  // namespace seedframe

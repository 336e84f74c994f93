// Which variables pin the kernels of a worker, and what is said of one that has others.

#include "render/worker_conditions.h"

#include <cstdlib>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace seedframe {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Key;
using ::testing::Not;
using ::testing::Pair;

WorkerConditions pinned_to(Isa isa) { return {.kernels = kernels_of(isa)}; }

WorkerConditions on(RenderDevice device) {
  WorkerConditions conditions;
  conditions.device = device;
  return conditions;
}

ReadyMessage worker_with(const std::string& kernel, const std::string& embree) {
  ReadyMessage ready;
  ready.kernel = kernel;
  ready.embree = embree;
  return ready;
}

TEST(WorkerConditions, APinNamesBothKernels) {
  const auto avx = environment_of(pinned_to(Isa::kAvx), "/lib/worker_cpu.so");
  EXPECT_THAT(avx, Contains(Pair("CYCLES_CPU_NO_AVX2", "1")));
  EXPECT_THAT(avx, Contains(Pair("SEEDFRAME_EMBREE_ISA", "avx")));
  const auto sse41 = environment_of(pinned_to(Isa::kSse41), "/lib/worker_cpu.so");
  EXPECT_THAT(sse41, Contains(Pair("CYCLES_CPU_NO_AVX", "1")));
  EXPECT_THAT(sse41, Contains(Pair("CYCLES_CPU_NO_SSE42", "1"))) << "that of Blender 4.2";
  EXPECT_THAT(sse41, Contains(Pair("CYCLES_CPU_NO_AVX2", "1"))) << "Blender 4 has no AVX alone";
  EXPECT_THAT(sse41, Not(Contains(Key("CYCLES_CPU_NO_SSE41"))));
  const auto sse42 = environment_of(pinned_to(Isa::kSse42), "/lib/worker_cpu.so");
  EXPECT_THAT(sse42, Contains(Pair("CYCLES_CPU_NO_AVX2", "1")));
  EXPECT_THAT(sse42, Not(Contains(Key("CYCLES_CPU_NO_SSE42"))));
  EXPECT_THAT(sse41, Contains(Pair("SEEDFRAME_EMBREE_ISA", "sse4.2")));
  const auto best = environment_of(pinned_to(Isa::kAvx2), "/lib/worker_cpu.so");
  EXPECT_THAT(best, Contains(Pair("SEEDFRAME_EMBREE_ISA", "avx2"))) << "and no AVX-512";
  EXPECT_EQ(best.size(), 3u);
}

TEST(WorkerConditions, WithoutAPinNothingIsChosen) {
  const auto environment = environment_of({}, "/lib/worker_cpu.so");
  EXPECT_THAT(environment, Contains(Pair("LD_PRELOAD", "/lib/worker_cpu.so")));
  EXPECT_THAT(environment, Not(Contains(Key("SEEDFRAME_EMBREE_ISA"))));
  EXPECT_EQ(environment_of({}, {}).size(), 1u) << "the allocator's settings";
}

TEST(WorkerConditions, WhatOthersPreloadStaysBehindOurs) {
  ASSERT_EQ(setenv("LD_PRELOAD", "/lib/other.so", 1), 0);
  const auto environment = environment_of({}, "/lib/worker_cpu.so");
  unsetenv("LD_PRELOAD");
  EXPECT_EQ(environment.at("LD_PRELOAD"), "/lib/worker_cpu.so:/lib/other.so");
}

TEST(WorkerConditions, TheAllocatorKeepsItsMemoryUnlessTheUserSetsItOtherwise) {
  EXPECT_THAT(environment_of({}, {}).at("MALLOC_CONF"), HasSubstr("dirty_decay_ms:-1"));
  ASSERT_EQ(setenv("MALLOC_CONF", "narenas:1", 1), 0);
  EXPECT_TRUE(environment_of({}, {}).empty());
  unsetenv("MALLOC_CONF");
}

TEST(WorkerConditions, AMissingDeviceIsRefusedWithThoseThatThereAre) {
  ReadyMessage ready = worker_with("avx2", "avx2");
  ready.device = "";
  ready.devices = "CPU (Some CPU), HIP (Some card)";
  EXPECT_TRUE(check_worker({}, ready));
  const Status none = check_worker(on(RenderDevice::kOptix), ready);
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().kind, ErrorKind::kEnvironment);
  EXPECT_THAT(none.error().message, HasSubstr("render.device is optix"));
  EXPECT_THAT(none.error().message, HasSubstr("only CPU (Some CPU), HIP (Some card)"));
  ready.device = "HIP (Some card)";
  EXPECT_TRUE(check_worker(on(RenderDevice::kHip), ready));
}

TEST(WorkerConditions, AMissingDenoiserIsRefusedWithWhatToDo) {
  ReadyMessage ready = worker_with("avx2", "avx2");
  ready.blender = "3.4.1";
  WorkerConditions denoising;
  denoising.denoise = true;
  const Status none = check_worker(denoising, ready);
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().kind, ErrorKind::kEnvironment);
  EXPECT_THAT(none.error().message, HasSubstr("this Blender 3.4.1 was built without it"));
  ready.denoisers = "OpenImageDenoise, OptiX";
  EXPECT_TRUE(check_worker(denoising, ready));
}

TEST(WorkerConditions, AWorkerThatCannotKeepThemIsRefused) {
  EXPECT_TRUE(check_worker({}, worker_with("sse2", "")));
  EXPECT_TRUE(check_worker(pinned_to(Isa::kSse41), worker_with("sse41", "sse4.2")));

  const Status old = check_worker(pinned_to(Isa::kAvx2), worker_with("avx", "avx"));
  ASSERT_FALSE(old);
  EXPECT_EQ(old.error().kind, ErrorKind::kEnvironment);
  EXPECT_THAT(old.error().message, HasSubstr("kernel avx2, and on this machine it uses avx"));

  const Status silent = check_worker(pinned_to(Isa::kAvx2), worker_with("avx2", ""));
  ASSERT_FALSE(silent);
  EXPECT_THAT(silent.error().message, HasSubstr("not a library of its own"));
}

}  // namespace
}  // namespace seedframe

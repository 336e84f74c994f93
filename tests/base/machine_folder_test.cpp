// The folder of a machine's processes: each has one of its own, which goes with it.

#include "base/machine_folder.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/files.h"
#include "tests/fixtures/scratch_folder.h"

namespace seedframe {
namespace {

namespace fs = std::filesystem;

TEST(MachineFolder, EachProcessHasAFolderThatGoesWithIt) {
  const ScratchFolder scratch;
  const auto machine = MachineFolder::open(scratch / "machine");
  ASSERT_TRUE(machine) << machine.error().message;
  fs::path folder;
  {
    const auto own = machine->make_own();
    ASSERT_TRUE(own);
    const auto other = machine->make_own();
    ASSERT_TRUE(other);
    EXPECT_NE(own->folder(), other->folder());
    folder = own->folder();
    ASSERT_TRUE(make_folders(folder));
    ASSERT_TRUE(MachineFolder::open(scratch / "machine"));
    EXPECT_TRUE(fs::exists(folder)) << "whoever comes meanwhile leaves it alone";
  }
  EXPECT_FALSE(fs::exists(folder.parent_path()));
}

TEST(MachineFolder, WhatAKilledProcessLeftGoesWithTheNext) {
  const ScratchFolder scratch;
  const pid_t child = ::fork();
  if (child == 0) {
    const auto machine = MachineFolder::open(scratch / "machine");
    const auto own = machine->make_own();
    (void)make_folders(own->folder());
    ::_exit(0);  // without its destructor
  }
  ::waitpid(child, nullptr, 0);
  const auto count = [&] {
    return std::distance(fs::directory_iterator(scratch / "machine"), fs::directory_iterator());
  };
  EXPECT_EQ(count(), 3);  // assets, meshes and its own
  ASSERT_TRUE(MachineFolder::open(scratch / "machine"));
  EXPECT_EQ(count(), 2);
}

TEST(MachineFolder, IsNobodyElses) {
  const ScratchFolder scratch;
  ASSERT_TRUE(make_folders(scratch / "machine"));
  ::chmod((scratch / "machine").c_str(), 0777);
  const auto machine = MachineFolder::open(scratch / "machine");
  ASSERT_FALSE(machine);
  EXPECT_EQ(machine.error().kind, ErrorKind::kEnvironment);
}

}  // namespace
}  // namespace seedframe

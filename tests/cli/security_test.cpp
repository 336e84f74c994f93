// Hostile configs, assets and names, as the program meets them: within 2 GB, soon, and with a
// message.

#include <chrono>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include "tests/cli/program.h"

namespace seedframe {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class SecurityTest : public ProgramTest {
 protected:
  void SetUp() override {
    for (const char* name : {"mine", "other"}) fs::create_directories(folder_ / name);
    fs::copy(fs::path(SEEDFRAME_HOME) / "assets/gear", folder_ / "other/cog");
    fs::copy(fs::path(SEEDFRAME_HOME) / "assets/gear", folder_ / "mine/gear");
  }

  /// Of `seedframe` in <folder>/mine, where 2 GB of address space are all it gets; with
  /// AddressSanitizer, whose shadow alone is 16 TB of it, as much as it likes.
  Outcome run_small(std::vector<std::string> arguments) {
#ifdef __SANITIZE_ADDRESS__
    constexpr rlim_t kLimit = RLIM_INFINITY;
#else
    constexpr rlim_t kLimit = 2'000'000'000;
#endif
    rlimit before{};
    ::getrlimit(RLIMIT_AS, &before);
    const rlimit small{kLimit, before.rlim_max};
    ::setrlimit(RLIMIT_AS, &small);
    const auto begin = std::chrono::steady_clock::now();
    const pid_t pid = start(arguments);
    ::setrlimit(RLIMIT_AS, &before);
    Outcome outcome = wait(pid);
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
    EXPECT_LT(seconds.count(), 60.0);
    return outcome;
  }
  void expect_refused(const std::string& text, const std::string& message) {
    write("bomb.yaml", text);
    const Outcome outcome = run_small({"check", "bomb.yaml"});
    EXPECT_EQ(outcome.exit_code, 2) << outcome.errors.substr(0, 2000);
    EXPECT_THAT(outcome.errors.substr(0, 2000), HasSubstr(message));
  }
};

std::string repeated(const std::string& text, std::size_t times) {
  std::string out;
  for (std::size_t i = 0; i < times; ++i) out += text;
  return out;
}

const std::string kStart = "seedframe: 1\ncamera: {distance_m: 1}\n";
constexpr const char* kLabels = R"(seedframe: 1
categories: [gear]
labels: geometry
render: {width: 32, height: 32}
asset_folders: [parts]
objects: {o: {asset: cog, category: gear}}
camera: {target: [0, 0, 0], distance_m: 0.3}
)";

TEST_F(SecurityTest, FoldersAreAllowedByTheUserAndRememberedForResume) {
  write("mine/scene.yaml", kLabels);
  // Outside of the config's folder and of the working directory, which is folder_/mine here.
  const ScratchFolder outside;
  fs::rename(folder_ / "other/cog", outside / "cog");
  Json description = *parse_json(*read_file(outside / "cog/asset.json"), "asset.json");
  description["name"] = "cog";
  ASSERT_TRUE(write_file(outside / "cog/asset.json", readable_json(description)));
  fs::create_directory_symlink(outside, folder_ / "mine/parts");

  const Outcome refused = run({"submit", "mine/scene.yaml", "-o", "c"});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.errors,
              HasSubstr("mine/scene.yaml:5:17: asset_folders[0]: 'parts' leads to " +
                        fs::canonical(outside.path()).string()));
  EXPECT_FALSE(exists("c"));
  EXPECT_EQ(run({"check", "mine/scene.yaml"}).exit_code, 2);
  EXPECT_EQ(run({"check", "mine/scene.yaml", "--allow", outside.string()}).exit_code, 0);
  EXPECT_EQ(run({"check", "mine/scene.yaml", "--allow", "no/such/folder"}).exit_code, 2);

  const Outcome allowed =
      run({"submit", "mine/scene.yaml", "-o", "c", "--allow", outside.string()});
  EXPECT_EQ(allowed.exit_code, 0) << allowed.errors;
  EXPECT_EQ(run({"resume", "c", "--frame", "0"}).exit_code, 0);
  EXPECT_EQ(run({"explain", "c", "0"}).exit_code, 0);
  EXPECT_EQ(run({"export", "c", "--format", "coco"}).exit_code, 0);
  const std::string campaign = folder_ / "c";
  folder_ /= "other";  // another working directory
  EXPECT_EQ(run({"resume", campaign, "--frame", "0"}).exit_code, 0);
  folder_ = folder_.parent_path();
}

TEST_F(SecurityTest, Bombs) {
  std::string laughs = "a0: &a0 [x, x, x, x, x, x, x, x, x, x]\n";
  for (int i = 1; i < 30; ++i) {
    laughs += fmt::format("a{}: &a{} [", i, i) + repeated(fmt::format("*a{},", i - 1), 10) + "]\n";
  }
  expect_refused(laughs + kStart, "more than 250000 values");
  expect_refused(kStart + "x: [" + repeated("0,\n", 5 << 20) + "]\n", "more than 250000 values");
  expect_refused(kStart + "x: " + repeated("[", 1 << 19), "more than 64 levels");
  expect_refused(kStart + "x: " + repeated("[\n", 7 << 20), "more than 64 levels");
  expect_refused(kStart + "x: " + repeated("[", 8 << 20),
                 "the line has more than 1048576 characters");
  expect_refused(repeated("? ", 1 << 18), "bomb.yaml");
  expect_refused(repeated("a", 17 << 20), "more than 16777216 bytes");
  // As large as may be, and all of it used.
  const std::string numbers = "[" + repeated("-1,", 240'000) + "]";
  expect_refused(kStart + "lights: {l: {power: {choice: " + numbers + "}}}\n", "power");
  const auto variables = [](int count, const std::string& last) {
    std::string text = "variables:\n  scene:\n";
    for (int i = 0; i + 1 < count; ++i) text += fmt::format("    v{}: v{}\n", i, i + 1);
    return text + fmt::format("    v{}: {}\n", count - 1, last);
  };
  expect_refused(kStart + variables(100'000, "1"),
                 "at most 10000 names are possible, found 100000");
  expect_refused(kStart + variables(10'000, "nothing"), "'nothing'");
  expect_refused(kStart + variables(10'000, "v0"), "circle");
  expect_refused(kStart + "variables: {scene: {a: \"" + repeated("${", 1 << 18) + "\"}}\n",
                 "bomb.yaml");
  std::string lights = "lights:\n";
  for (int i = 0; i < 10'000; ++i) lights += fmt::format("  l{}: {{power: -1}}\n", i);
  expect_refused(kStart + lights, "power");
  std::string groups = "objects:\n";
  for (int g = 0; g < 6; ++g) {
    groups += fmt::format("  g{}:\n    objects:\n", g);
    for (int i = 0; i < 9'000; ++i) groups += fmt::format("      o{}: {{asset: gaer}}\n", i);
  }
  expect_refused(kStart + groups, "gaer");
}

TEST_F(SecurityTest, CountsAndGrids) {
  const auto with = [](const std::string& object) {
    return "seedframe: 1\ncategories: [gear]\ncamera: {distance_m: 1}\nobjects: {o: {asset: "
           "gear, " +
           object + "}}\n";
  };
  expect_refused(with("count: 1e300"), "a count must be from 0 to 32767");
  expect_refused(with("count: 1e999"), "must be finite");
  expect_refused(with("count: {poisson: 1e300}"), "bomb.yaml");
  expect_refused(with("grid: {counts: [1e9, 1e9, 1e9]}"), "bomb.yaml");
  expect_refused(with("grid: {counts: [30000, 30000, 30000]}"), "bomb.yaml");
  expect_refused(kStart + "lights: {l: {power: 1, count: 1e18}}\n", "bomb.yaml");
  expect_refused(
      "seedframe: 1\ncategories: [gear]\ncamera: {distance_m: 1}\nobjects: {g: {count: 30000, "
      "objects: "
      "{o: {asset: gear, count: 1024}}}}\n",
      "bomb.yaml");
  expect_refused(kStart + "camera: {distance_m: 1}\n", "is given twice");
}

TEST_F(SecurityTest, MeshesThatClaimToBeHuge) {
  const auto refused = [&](const std::string& name, const std::string& bytes) {
    write(name, bytes);
    const Outcome outcome = run_small({"asset", "import", name, "--root", "lib", "--name", "x"});
    EXPECT_EQ(outcome.exit_code, 2) << name << outcome.errors;
    EXPECT_THAT(outcome.errors, HasSubstr(name));
    EXPECT_FALSE(exists("lib/x"));
  };
  const std::string ply =
      "ply\nformat binary_little_endian 1.0\nelement vertex 1099511627776\n"
      "property float x\nproperty float y\nproperty float z\n"
      "element face 1099511627776\nproperty list uint uint vertex_indices\nend_header\n";
  refused("a.ply", ply);
  refused("b.ply", ply + std::string(1000, '\xff'));
  refused("c.stl", std::string(80, ' ') + "\xff\xff\xff\xff" + std::string(1000, '\0'));
  refused("d.off", "OFF\n1099511627776 1099511627776 0\n0 0 0\n");
  refused("e.gltf",
          R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":1099511627776,"uri":"e.bin"}]})");
  refused("f.gltf", R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":1099511627776}]})");
  refused(
      "g.gltf",
      R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":8,"uri":"../../../etc/passwd"}]})");
  refused("h.gltf", "{\"asset\":" + std::string(4 << 20, '['));
  refused("i.obj", repeated("f 1 2 3\n", 1 << 20));
  write("j.stl", "x");
  fs::resize_file(folder_ / "j.stl", std::uintmax_t{1} << 40);
  EXPECT_EQ(run_small({"asset", "import", "j.stl", "--root", "lib", "--name", "x"}).exit_code, 2);
}

TEST_F(SecurityTest, NothingIsWrittenThroughLinks) {
  write("precious.txt", "precious");
  fs::create_symlink(folder_ / "precious.txt", folder_ / "mine/gear/thumbnail.png.tmp");
  EXPECT_NE(run({"asset", "thumbnail", "gear", "--root", "mine"}).exit_code, 0);
  EXPECT_EQ(*read_file(folder_ / "precious.txt"), "precious");
  fs::create_directories(folder_ / "away");
  fs::rename(folder_ / "mine/gear", folder_ / "away/gear");
  fs::create_directory_symlink(folder_ / "away/gear", folder_ / "mine/gear");
  for (const char* action : {"thumbnail", "list", "check"}) {
    const Outcome outcome = run({"asset", action, "--root", "mine"});
    EXPECT_EQ(outcome.exit_code, 2) << action;
    EXPECT_THAT(outcome.errors, HasSubstr("outside of the folders")) << action;
  }
}

TEST_F(SecurityTest, TerminalsAreNotObeyed) {
  write("t.yaml", "seedframe: 1\ncamera: {distance_m: 1}\nworld: {hdri: \"\\e[2J\\x9b\"}\n");
  const Outcome outcome = run({"check", "t.yaml"});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_EQ(outcome.errors.find('\x1b'), std::string::npos);
  EXPECT_EQ(outcome.errors.find("\xc2\x9b"), std::string::npos);
  EXPECT_THAT(outcome.errors, HasSubstr("'?[2J?'"));
}

TEST_F(SecurityTest, ExportsOfHostileNamesStayInTheirFolder) {
  const std::string longest(200, 'x');
  write("names.yaml", R"(seedframe: 1
labels: geometry
render: {width: 64, height: 64}
categories: ["../../../evil", "/etc/evil", "..", ".", "-rf", "~", "a/b", "a\\b", "a b", "A B", "con", "*?<>|",
             "%2e%2e", "日本", "no", "{split}", "]]>&<!--", "'; DROP", )" +
                          longest + R"(, )" + longest.substr(0, 199) +
                          R"(y]
objects: {o: {asset: gear, category: {choice: ["../../../evil", "..", "-rf", "a/b", "]]>&<!--", )" +
                          longest + R"(]},
              count: 8, position: [{uniform: [-0.05, 0.05]}, {uniform: [-0.05, 0.05]}, 0]}}
frames_per_scene: 4
camera: {target: [0, 0, 0], distance_m: 0.3}
)");
  const Outcome submitted = run({"submit", "names.yaml", "-o", "deep/c", "--quiet"});
  ASSERT_EQ(submitted.exit_code, 0) << submitted.errors;
  const std::map<std::string, std::string> before = contents(".");
  std::vector<std::string> arguments = {"export", "deep/c", "-o", "deep/out/x"};
  for (const char* format : {"coco", "coco-polygon", "coco-panoptic", "yolo-detect", "yolo-segment",
                             "yolo-obb", "voc", "bop", "webdataset", "statistics"}) {
    arguments.insert(arguments.end(), {"--format", format});
  }
  const Outcome exported = run(arguments);
  ASSERT_EQ(exported.exit_code, 0) << exported.errors;
  std::size_t files = 0;
  for (const auto& [path, bytes] : contents(".")) {
    if (path == "out.txt" || path == "err.txt") continue;
    if (path.starts_with("deep/out/x/")) {
      ++files;
    } else {
      EXPECT_TRUE(before.contains(path) && before.at(path) == bytes) << path;
    }
  }
  EXPECT_GT(files, 50u);
  EXPECT_EQ(run({"export", "deep/c", "-o", "deep/out/x", "--verify"}).exit_code, 0);
  ASSERT_EQ(run({"submit", "names.yaml", "-o", "colon", "--quiet", "--set", "frames_per_scene=1",
                 "--set", "categories=['a:b']", "--set", "objects.o.category='a:b'"})
                .exit_code,
            0);
  const Outcome refused = run({"export", "colon", "--format", "voc"});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.errors, HasSubstr("labelmap.txt cannot name the class 'a:b'"));
}

TEST_F(SecurityTest, ACampaignIsWrittenBelowResults) {
  write("...yaml", kLabels);
  const Outcome outcome =
      run({"submit", "...yaml", "--set", "asset_folders=[mine]", "--set", "objects.o.asset=gear"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
  EXPECT_TRUE(exists("results/_./campaign.yaml"));
  for (const char* name : {"../../x", "/x", "..", "a/b"}) {
    const Outcome refused = run({"submit", "...yaml", "--set", std::string("name=") + name});
    EXPECT_EQ(refused.exit_code, 2);
    EXPECT_THAT(refused.errors, HasSubstr("a campaign's name is letters"));
  }
}

}  // namespace
}  // namespace seedframe

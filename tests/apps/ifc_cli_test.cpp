// SPDX-License-Identifier: MIT
// `scene import` of IFC files through IfcOpenShell (scripts/setup.sh ifc); skipped where it is
// missing. shared/data/ifc/Duplex.ifc is beside the repository in its workplaces only.
// CROSSNAV_LONG_TESTS=1 mutates 300 files instead of 6.
#include <array>
#include <chrono>

#include "cli_fixture.h"
#include "crossnav/core/rng.h"
#include "support/places.h"

namespace crossnav::test {
namespace {

const fs::path kDuplex = test::SharedPath("data/ifc/Duplex.ifc");

class IfcCli : public Cli {
 protected:
  /// A wall, a door, two spaces; `extra` are further lines of data.
  static std::string SmallIfc(const std::string& extra = "") {
    return "ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION((''),'2;1');\n"
           "FILE_NAME('','',(''),(''),'','','');\nFILE_SCHEMA(('IFC4'));\nENDSEC;\nDATA;\n"
           "#1=IFCPROJECT('0000000000000000000001',$,'p',$,$,$,$,(#5),#9);\n"
           "#2=IFCCARTESIANPOINT((0.,0.,0.));\n#3=IFCAXIS2PLACEMENT3D(#2,$,$);\n"
           "#5=IFCGEOMETRICREPRESENTATIONCONTEXT($,'Model',3,1.E-5,#3,$);\n"
           "#8=IFCSIUNIT(*,.LENGTHUNIT.,$,.METRE.);\n#9=IFCUNITASSIGNMENT((#8));\n"
           "#10=IFCBUILDINGSTOREY('0000000000000000000002',$,'EG',$,$,#11,$,$,.ELEMENT.,0.);\n"
           "#11=IFCLOCALPLACEMENT($,#3);\n"
           "#12=IFCRELAGGREGATES('0000000000000000000003',$,$,$,#1,(#10));\n"
           "#13=IFCRELAGGREGATES('0000000000000000000004',$,$,$,#10,(#30,#31));\n" +
           Box(20, "IFCWALL('0000000000000000000005',$,'w',$,$,#11,#28,$,$)", 4.1, 0.5, 0.2, 1) +
           Box(30,
               "IFCSPACE('0000000000000000000006',$,'1',$,$,#11,#38,'K\\X2\\00FC\\X0\\che',"
               ".ELEMENT.,.INTERNAL.,$)",
               2, 2, 4, 4) +
           Box(40,
               "IFCSPACE('0000000000000000000007',$,'2',$,$,#11,#48,'Bedroom',"
               ".ELEMENT.,.INTERNAL.,$)",
               6.5, 2, 5, 4) +
           extra + "ENDSEC;\nEND-ISO-10303-21;\n";
  }

  /// An upright prism of 2.5 m, as item `n` and the eight after it.
  static std::string Box(int n, const std::string& product, double x, double y, double dx,
                         double dy) {
    const auto id = [n](int k) { return "#" + std::to_string(n + k); };
    const auto real = [](double v) {
      const std::string text = std::to_string(v);
      return text.substr(0, text.find('.') + 3);
    };
    std::string text = id(0) + "=" + product + ";\n";
    if (product.rfind("IFCSPACE", 0) == 0 && n == 40) text.replace(1, 2, "31");
    return text + id(2) + "=IFCCARTESIANPOINT((" + real(x) + "," + real(y) + "));\n" + id(3) +
           "=IFCAXIS2PLACEMENT2D(" + id(2) + ",$);\n" + id(4) +
           "=IFCRECTANGLEPROFILEDEF(.AREA.,$," + id(3) + "," + real(dx) + "," + real(dy) + ");\n" +
           id(5) + "=IFCDIRECTION((0.,0.,1.));\n" + id(6) + "=IFCEXTRUDEDAREASOLID(" + id(4) +
           ",#3," + id(5) + ",2.5);\n" + id(7) +
           "=IFCSHAPEREPRESENTATION(#5,'Body','SweptSolid',(" + id(6) + "));\n" + id(8) +
           "=IFCPRODUCTDEFINITIONSHAPE($,$,(" + id(7) + "));\n";
  }

  bool HasReader() {
    WriteText(At("probe.ifc"), SmallIfc());
    return Run("scene import probe.ifc --out probed").err.find("has no Python package") ==
           std::string::npos;
  }

  /// One line, exit status 1, nothing written, in time.
  void ExpectRefused(const std::string& name, const std::string& bytes) {
    WriteText(At(name), bytes);
    const auto begin = std::chrono::steady_clock::now();
    const Outcome outcome = Run("scene import " + name + " --out none --seconds 5");
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
    EXPECT_EQ(outcome.exit_code, 1) << name << outcome.err;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_NE(outcome.err.find(name), std::string::npos) << outcome.err;
    EXPECT_LT(took.count(), 20) << name;
    EXPECT_FALSE(fs::exists(At("none")));
  }
};

TEST_F(IfcCli, WithoutTheReaderOneLineSaysWhatToInstall) {
  WriteText(At("a.ifc"), SmallIfc());
  const Outcome none = RunIn(folder_, "scene import a.ifc --out o", "CROSSNAV_PYTHON=no/python");
  EXPECT_EQ(none.exit_code, 1);
  EXPECT_NE(none.err.find("scripts/setup.sh ifc"), std::string::npos) << none.err;
  EXPECT_NE(none.err.find("CROSSNAV_PYTHON"), std::string::npos) << none.err;
  EXPECT_EQ(std::count(none.err.begin(), none.err.end(), '\n'), 1) << none.err;
  ExpectFailure("scene import none.ifc --out o", {"none.ifc"});
}

TEST_F(IfcCli, RoomsOfAnIfc4FileBecomeFloors) {
  if (!HasReader()) GTEST_SKIP() << "no IfcOpenShell; scripts/setup.sh ifc installs it";
  WriteText(At("a.ifc"), SmallIfc());
  const Outcome done = Run("scene import a.ifc --out o --json --furnish 1 --furniture none");
  ASSERT_EQ(done.exit_code, 0) << done.err;
  const Json report = Json::parse(done.out);
  EXPECT_EQ(report["rooms"], 2);
  EXPECT_EQ(report["storeys"][0]["name"], "EG");
  EXPECT_GT(report["area_m2"], 12);
}

TEST_F(IfcCli, DamagedHugeAndHostileFilesAreRefusedInOneLine) {
  if (!HasReader()) GTEST_SKIP() << "no IfcOpenShell; scripts/setup.sh ifc installs it";
  const std::string whole = SmallIfc();
  ExpectRefused("empty.ifc", "");
  ExpectRefused("garbage.ifc", std::string(5000, '\x81'));
  ExpectRefused("cut.ifc", whole.substr(0, whole.size() / 2));
  ExpectRefused("schema.ifc", std::string(whole).replace(whole.find("IFC4"), 4, "IFC9"));
  std::string far = whole;
  for (auto at = far.find("4.10,"); at != far.npos; at = far.find("4.10,", at + 1)) {
    far.replace(at, 5, "1.E300,");
  }
  WriteText(At("far.ifc"), far);
  EXPECT_LE(Run("scene import far.ifc --out far --seconds 5").exit_code, 1);
  std::string bomb;  // each item names the one before it twice
  for (int i = 100; i < 140; ++i) {
    bomb += "#" + std::to_string(i) + "=IFCBOOLEANRESULT(.UNION.,#" +
            std::to_string(i == 100 ? 26 : i - 1) + ",#" + std::to_string(i == 100 ? 26 : i - 1) +
            ");\n";
  }
  bomb +=
      "#150=IFCSHAPEREPRESENTATION(#5,'Body','CSG',(#139));\n"
      "#151=IFCPRODUCTDEFINITIONSHAPE($,$,(#150));\n"
      "#152=IFCWALL('0000000000000000000008',$,'b',$,$,#11,#151,$,$);\n";
  ExpectRefused("bomb.ifc", SmallIfc(bomb));
}

/// A reader that is none: prints `text`, then waits.
std::string FakeReader(const fs::path& folder, const std::string& text, int waits_s) {
  WriteText(folder / "answer", text);
  const fs::path script = folder / "reader.sh";
  WriteText(script, "#!/bin/sh\ncat '" + (folder / "answer").string() + "'\nexec sleep " +
                        std::to_string(waits_s) + "\n");
  fs::permissions(script, fs::perms::owner_all);
  return "CROSSNAV_PYTHON='" + script.string() + "'";
}

/// Storeys that a hundred staircases join, of which each has to be tried.
std::string ManyStaircases() {
  Json building = {{"format", 1}, {"schema", "IFC4"}, {"notes", Json::array()}};
  Json storeys = Json::array(), spaces = Json::array(), elements = Json::array();
  for (int k = 0; k < 11; ++k) {
    const double z = 3.0 * k;
    storeys.push_back({{"name", "s"}, {"floor_m", z}});
    spaces.push_back({{"names", {"hall"}},
                      {"storey", k},
                      {"floor_m", z},
                      {"height_m", 2.7},
                      {"outside", false},
                      {"outline", Json::parse("[[0,0],[60,0],[60,40],[0,40]]")}});
    for (int i = 0; i < 10 && k < 10; ++i) {
      const double x = 3.0 + 5 * i, y = 5;
      elements.push_back(
          {{"kind", "stairs"},
           {"names", {"stair"}},
           {"storey", k},
           {"axis", {1, 0}},
           {"vertices", {x, y, z, x + 1, y, z, x + 1, y + 4, z + 3, x, y + 4, z + 3}},
           {"triangles", {0, 1, 2, 0, 2, 3}},
           {"colours", -1}});
    }
  }
  building["storeys"] = storeys;
  building["colours"] = Json::array();
  building["spaces"] = spaces;
  building["elements"] = elements;
  return building.dump();
}

TEST_F(IfcCli, AnImportEndsAtItsLimitOfWallTime) {
  WriteText(At("a.ifc"), SmallIfc());
  const std::pair<std::string, int> readers[] = {{"", 60}, {ManyStaircases(), 0}};
  for (const auto& [text, waits_s] : readers) {
    const std::string before = FakeReader(folder_.path(), text, waits_s);
    const auto begin = std::chrono::steady_clock::now();
    const Outcome outcome = RunIn(folder_, "scene import a.ifc --out none --seconds 2", before);
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
    EXPECT_EQ(outcome.exit_code, 1) << outcome.out;
    EXPECT_NE(outcome.err.find("takes more than 2 s"), std::string::npos) << outcome.err;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_LT(took.count(), 6);
    EXPECT_FALSE(fs::exists(At("none")));
  }
}

TEST_F(IfcCli, ATruncatedFileIsRefusedInOneLineOrReadInPart) {
  if (!HasReader()) GTEST_SKIP() << "no IfcOpenShell; scripts/setup.sh ifc installs it";
  const std::string whole = SmallIfc(), end = "\nENDSEC;\nEND-ISO-10303-21;\n";
  constexpr std::size_t kCuts = 5;
  for (std::size_t i = 1; i <= kCuts; ++i) {
    const std::string cut = whole.substr(0, i * whole.size() / (kCuts + 1));
    ExpectRefused("cut.ifc", cut);
    WriteText(At("ended.ifc"), cut + end);
    const Outcome outcome = Run("scene import ended.ifc --out ended");
    EXPECT_LE(outcome.exit_code, 1) << outcome.err;
    if (outcome.exit_code == 0) continue;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_FALSE(fs::exists(At("ended"))) << i;
  }
}

/// One to eight changes of a file: bytes, numbers, names of items, lines that are gone or twice.
std::string Mutated(std::string text, Rng& rng) {
  constexpr std::array kHostile = {"-1.", "0.", "1.E300", "NAN", "99999999", "$", "*", "()", "''"};
  const auto at = [&] { return rng.Below(static_cast<std::uint32_t>(text.size())); };
  for (int change = rng.Int(1, 8); change > 0; --change) {
    const std::size_t line = text.find('\n', at());
    const std::size_t next = line == text.npos ? text.npos : text.find('\n', line + 1);
    const std::size_t number = text.find_first_of("0123456789", at());
    switch (rng.Below(5)) {
      case 0:
        text[at()] = static_cast<char>(rng.Int(0, 255));
        break;
      case 1:
        if (next != text.npos) text.erase(line, next - line);
        break;
      case 2:
        if (next != text.npos) text.insert(next, text.substr(line, next - line));
        break;
      case 3:
        if (number != text.npos)
          text.replace(number, text.find_first_not_of("0123456789.", number) - number,
                       kHostile[rng.Below(kHostile.size())]);
        break;
      default:
        if (number != text.npos) text[number] = static_cast<char>('0' + rng.Int(0, 9));
    }
  }
  return text;
}

TEST_F(IfcCli, AMutatedFileIsRefusedInOneLineOrBecomesAScene) {
  if (!HasReader()) GTEST_SKIP() << "no IfcOpenShell; scripts/setup.sh ifc installs it";
  const std::uint64_t files = std::getenv("CROSSNAV_LONG_TESTS") != nullptr ? 300 : 6;
  for (std::uint64_t seed = 0; seed < files; ++seed) {
    Rng rng(seed, 0);
    const std::string bytes = Mutated(SmallIfc(), rng);
    WriteText(At("mutated.ifc"), bytes);
    const auto begin = std::chrono::steady_clock::now();
    const Outcome outcome = Run("scene import mutated.ifc --out mutated --seconds 5");
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
    EXPECT_LT(took.count(), 20) << seed;
    EXPECT_EQ(fs::exists(At("mutated")), outcome.exit_code == 0) << seed << outcome.err;
    fs::remove_all(At("mutated"));
    if (outcome.exit_code == 0) continue;
    EXPECT_EQ(outcome.exit_code, 1) << seed << outcome.err;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << seed << outcome.err;
    EXPECT_NE(outcome.err.find("mutated.ifc"), std::string::npos) << seed << outcome.err;
  }
}

TEST_F(IfcCli, TheSameFileAndSeedGiveTheSameBytes) {
  if (!HasReader()) GTEST_SKIP() << "no IfcOpenShell; scripts/setup.sh ifc installs it";
  WriteText(At("a.ifc"), SmallIfc());
  for (const char* out : {"one", "two"}) {
    const Outcome done =
        Run(std::string("scene import a.ifc --furnish 3 --furniture none --out ") + out);
    ASSERT_EQ(done.exit_code, 0) << done.err;
  }
  int files = 0;
  for (const auto& entry : fs::recursive_directory_iterator(At("one"))) {
    if (!entry.is_regular_file()) continue;
    ++files;
    const fs::path same = At("two") / fs::relative(entry.path(), At("one"));
    EXPECT_EQ(ReadText(entry.path()), ReadText(same)) << same;
  }
  EXPECT_GE(files, 4);
}

TEST_F(IfcCli, TheDuplexHasTwoStoreysThatItsStairsJoin) {
  if (!fs::exists(kDuplex)) GTEST_SKIP() << "no " << kDuplex;
  if (!HasReader()) GTEST_SKIP() << "no IfcOpenShell; scripts/setup.sh ifc installs it";
  const Outcome done = Run("scene import '" + kDuplex.string() +
                           "' --out o --json --furnish 1 --furniture none --seconds 60");
  ASSERT_EQ(done.exit_code, 0) << done.err;
  const Json report = Json::parse(done.out);
  EXPECT_EQ(report["floors"].size(), 2U);
  EXPECT_EQ(report["connections"].size(), 1U);
  EXPECT_EQ(report["rooms"], 20);
  EXPECT_EQ(report["goals"]["bed"], 4);
  EXPECT_EQ(report["goals"]["toilet"], 4);
}

}  // namespace
}  // namespace crossnav::test

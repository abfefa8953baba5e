// Fields under laws of friction that do not follow the pressure, and fields under the wrong one of them.

#include "convergence/check/tests/checked_field.hpp"
#include "solver/grid/grid_transfer.hpp"

namespace slipstick::convergence {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

using Settings = std::vector<std::string>;

const Settings kTresca{"contact.friction_law=tresca", "contact.shear_strength=1e8"};
const Settings kCapped{"contact.friction_law=capped", "contact.shear_strength=1e8"};
const Settings kPower{"contact.friction_law=power", "contact.friction=2000", "contact.friction_exponent=0.5"};

solver::Scene under(Settings settings, int cells = 64, double ratio = 0.8) {
  settings.push_back(fmt::format("load.moment_ratio={}", ratio));
  return scene_of("paper", cells, settings);
}

TEST(CheckFrictionLaw, FindsRightFieldsGood) {
  for (const Settings& settings : {kTresca, kCapped, kPower}) {
    for (const double ratio : {0.3, 0.9}) {
      const solver::Scene scene = under(settings, 64, ratio);
      const Checked result = find_good(solved(scene), scene);
      EXPECT_TRUE(result["discrete"]["holds"].get<bool>());
    }
  }
}

TEST(CheckFrictionLaw, NamesTheLawThatWasUsed) {
  find_bad(solved(under({})), under(kTresca), names(mistake::coulomb_friction, 0.1));
  find_bad(solved(under({})), under(kPower), names(mistake::coulomb_friction, 0.1));
  find_bad(solved(under(kTresca)), under({}), names(mistake::tresca_friction, 1e8));
}

TEST(CheckFrictionLaw, NamesAWrongStrength) {
  Settings stronger = kTresca;
  stronger.back() = "contact.shear_strength=1.1e8";
  find_bad(solved(under(stronger)), under(kTresca), names(mistake::friction_factor, 1.1));
}

// Cells that the edge cuts may carry a part of the strength; no cell carries more.
TEST(CheckFrictionLaw, FindsAStrongerInterfaceBadOnCoarseMeshes) {
  for (const int cells : {24, 32, 48}) {
    for (const double ratio : {0.4, 0.7}) {
      const solver::Scene scene = under(kTresca, cells, ratio);
      const solver::Solution right = solver::solve(scene);
      find_good(rows_of(right), scene);
      for (const char* strength : {"1.1e8", "1.5e8", "0.9e8"}) {
        find_bad(solved(scene_of("paper", cells,
                                 {kTresca[0], fmt::format("contact.shear_strength={}", strength),
                                  fmt::format("load.moment={}", right.moment)})),
                 scene, testing::_);
      }
    }
  }
}

// A cell that the contact covers in part may carry that part of the strength.
TEST(CheckFrictionLaw, LeavesCellsOpenThatTheEdgeCuts) {
  Settings off_centre = kTresca;
  off_centre.insert(off_centre.end(), {"grid.extent=[1.9564e-3,1.9564e-3]", "upper.at=[5.223e-5,-2.555e-5]"});
  const solver::Scene scene = under(off_centre, 32, 0.7);
  const solver::Solution fine = solver::solve(under(off_centre, 96, 0.7));
  solver::Solution mean = solver::solve(scene);
  mean.pressure = restrict_to(mean.grid, fine.grid, fine.pressure);
  mean.traction = restrict_to(mean.grid, fine.grid, fine.traction);
  find_good(rows_of(mean), scene);
}

TEST(CheckFrictionLaw, NamesAnotherExponentAndTheMeanPressure) {
  Settings linear = kPower;
  linear[1] = "contact.friction=20";
  linear[2] = "contact.friction_exponent=0.75";
  find_bad(solved(under(linear)), under(kPower), names(mistake::power_friction, 0.75));
  find_bad(solved(under(kPower)), under({}), names(mistake::power_friction, 0.5));
  const solver::Solution solution = solver::solve(under({}));
  const double mean =
      solution.normal_load / static_cast<double>(solution.contact_cells) / solution.grid.cell_area();
  find_bad(solved(under({kTresca[0], fmt::format("contact.shear_strength={}", 0.1 * mean)})), under({}),
           names(mistake::mean_friction));
}

TEST(CheckFrictionLaw, SpeaksOfTheScenesLaw) {
  const FieldRows field = solved(under({}));
  for (const auto& [settings, law] :
       {std::pair{kTresca, "Tresca's law"}, {kCapped, "capped law"}, {kPower, "power law"}}) {
    const std::string said = check_rows(field, under(settings)).text;
    EXPECT_THAT(said.substr(0, said.find("likely")), Not(HasSubstr("Coulomb")));
    EXPECT_THAT(
        check_rows(solved(under(settings)), under(settings)).text,
        AllOf(HasSubstr(std::string(law)), Not(HasSubstr("above mu p by")), Not(HasSubstr("Coulomb: 0"))));
  }
}

TEST(CheckFrictionLaw, TakesAMap) {
  const std::filesystem::path map = temporary_file("check_map.csv");
  std::ofstream stream(map);
  for (int i = 0; i < 32; ++i) {
    for (int j = 0; j < 32; ++j) stream << (j > 0 ? "," : "") << (i < 16 ? 0.5 : 1.0);
    stream << '\n';
  }
  stream.close();
  const solver::Scene scene = under({fmt::format("contact.friction_map=\"{}\"", map.string())}, 32);
  find_good(solved(scene), scene);
  find_bad(solved(under({}, 32)), scene, testing::AnyOf(Breaks("friction"), Breaks("friction_bound")));
}

}  // namespace
}  // namespace slipstick::convergence

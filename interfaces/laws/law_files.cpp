#include "interfaces/laws/law_files.hpp"

#include <fmt/core.h>

#include <array>
#include <cctype>

#include "solver/input/input_error.hpp"

namespace slipstick::laws {

using namespace convergence;

namespace {

struct LawFormat {
  const char* ending;
  std::string (*text)(const ContactLaw&);
};
constexpr std::array kLawFormats{LawFormat{".csv", csv_table},         LawFormat{".h", c_header},
                                 LawFormat{".py", python_module},      LawFormat{".table", lammps_table},
                                 LawFormat{".inp", abaqus_behaviours}, LawFormat{".xml", mujoco_default},
                                 LawFormat{".sdf", drake_model}};

void require_units(const ContactLaw& law, const std::filesystem::path& path) {
  const std::string ending = path.extension().string();
  if (ending == ".xml" && !mujoco_friction(law)) {
    throw solver::InputError(fmt::format("--write {}", path.string()),
                             "MuJoCo's friction has a length; allowed: with a scene");
  }
  if (ending == ".sdf" && !drake_hydroelastic(law)) {
    throw solver::InputError(fmt::format("--write {}", path.string()),
                             "Drake's modulus needs a sphere; allowed: with the scene of a sphere");
  }
}

/// On one line: a scene's name may hold anything.
std::string on_one_line(std::string text) {
  for (char& letter : text) {
    if (static_cast<unsigned char>(letter) < ' ') letter = ' ';
  }
  return text;
}

}  // namespace

std::string law_file(const ContactLaw& law, const std::filesystem::path& path) {
  for (const auto& [ending, text] : kLawFormats) {
    if (path.extension() != ending) continue;
    require_units(law, path);
    return text(law);
  }
  throw solver::InputError(fmt::format("--write {}", path.string()),
                           "its ending says no format; allowed: .csv, .h, .py, .table, .inp, .xml, .sdf");
}

std::string capital_prefix_of(const ContactLaw& law) {
  std::string prefix = law.contact.prefix;
  for (char& letter : prefix) letter = static_cast<char>(std::toupper(static_cast<unsigned char>(letter)));
  return prefix;
}

std::string law_heading(const ContactLaw& law, const std::string& before) {
  const std::string units =
      law.contact.units ? fmt::format("rad, N m, J; normal load {} N, friction {}, contact radius {} m",
                                      law.contact.units->normal_load, law.contact.units->friction,
                                      law.contact.units->contact_radius)
                        : "rotations over mu W/(G a^2), moments over mu W a, energies over their product";
  return fmt::format(
      "{0}Torsion of {1}, profile {2}: first loading and its consequences, by slipstick law.\n"
      "{0}Units: {3}.\n",
      before, on_one_line(law.contact.name), on_one_line(law.contact.profile->name()), units);
}

}  // namespace slipstick::laws

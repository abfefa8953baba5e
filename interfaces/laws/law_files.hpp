#pragma once

#include <filesystem>
#include <string>

#include "convergence/laws/contact_law.hpp"

/// A contact law as files that other programs read. Numbers are the scene's, SI, or dimensionless.
namespace slipstick::laws {

using convergence::ContactLaw;

/// The file's text by its ending: .csv table; .h C header; .py Python module; .table LAMMPS; .inp Abaqus;
/// .xml MuJoCo; .sdf Drake. Throws InputError for another ending, and where a form needs units, or a sphere,
/// that the law has not.
std::string law_file(const ContactLaw& law, const std::filesystem::path& path);

/// The first lines of a file, each with `before` in front: the contact and the units.
std::string law_heading(const ContactLaw& law, const std::string& before);

/// The prefix of the law's names, in capitals.
std::string capital_prefix_of(const ContactLaw& law);

std::string c_header(const ContactLaw& law);
std::string python_module(const ContactLaw& law);

/// Rows of first loading: rotation, moment, stick_ratio, tangent_stiffness, energy_lost_per_cycle.
std::string csv_table(const ContactLaw& law);
/// A section as LAMMPS' bond_style table reads them, energy and its negative derivative over the rotation, at
/// equal steps: read with as many values as it has rows, LAMMPS takes these as they are.
std::string lammps_table(const ContactLaw& law);
/// Connector behaviours: nonlinear elastic first loading; the elements, elastic and plastic, in parallel.
std::string abaqus_behaviours(const ContactLaw& law);

/// MuJoCo needs units, Drake a sphere.
std::string mujoco_default(const ContactLaw& law);
std::string drake_model(const ContactLaw& law);

}  // namespace slipstick::laws

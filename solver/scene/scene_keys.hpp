#pragma once

#include <cstddef>

#include "solver/input/toml_reader.hpp"
#include "solver/scene/scene.hpp"
#include "solver/scene/surface_geometry.hpp"

/// Every key and word that a scene file may have, and the numbers that a scene may hold, whether a file or a
/// program sets them.
namespace slipstick::solver {

/// The keys that read_scene() reads. Scene and Surface define their defaults.
const SettingKeys& scene_keys();

/// Every law's word, and "none" for no layer.
const Words<const LawKind*>& layer_words();
inline const Words<Combine> kCombinations{{"sum", Combine::sum}, {"nearest", Combine::nearest}};
/// Each in m.
inline const Words<double> kHeightUnits{{"m", 1.0}, {"mm", 1e-3}, {"um", 1e-6}, {"nm", 1e-9}};
/// Sets of units by their length: its power of ten in m. Forces are in N.
inline const Words<int> kUnitSets{{"m", 0}, {"mm", -3}};
inline const Words<PressureModel> kPressureModels{{"solved", PressureModel::solved},
                                                  {"hertz", PressureModel::hertz},
                                                  {"hertz_averaged", PressureModel::hertz_averaged},
                                                  {"file", PressureModel::file}};
inline const Words<FrictionKind> kFrictionLaws{{"coulomb", FrictionKind::coulomb},
                                               {"tresca", FrictionKind::tresca},
                                               {"capped", FrictionKind::capped},
                                               {"power", FrictionKind::power}};
inline const Words<Coupling> kCouplings{{"auto", Coupling::automatic},
                                        {"none", Coupling::none},
                                        {"pressure", Coupling::pressure},
                                        {"full", Coupling::full}};
inline const Words<OperatorKind> kOperators{
    {"dcfft", OperatorKind::dcfft}, {"direct", OperatorKind::direct}, {"dense", OperatorKind::dense}};
inline const Words<Method> kMethods{{"coulomb", Method::coulomb}, {"paper", Method::paper}};
inline const Words<ModelChoice> kModels{
    {"auto", ModelChoice::automatic}, {"full", ModelChoice::full}, {"exact", ModelChoice::exact}};
inline const Words<CellTraction> kCellTractions{{"constant", CellTraction::constant}, {"smooth", CellTraction::smooth}};

inline const Range kRatio{"above -1 and below 1 (1 is gross slip)", [](double x) { return x > -1.0 && x < 1.0; }};
inline const Range kPoisson{"above -1, at most 0.5", [](double x) { return x > -1.0 && x <= 0.5; }};
inline const Range kTolerance{"from 1e-15 to below 1", [](double x) { return x >= 1e-15 && x < 1.0; }};
/// Cells along a side. Memory ends long before.
inline const Range kCells = whole(1, 65536);
/// The largest round number that fits an int.
inline const Range kIterations = whole(1, 1e9);
inline const Range kRoundingSeeds = whole(0, 1e9);
/// The error of a path goes like one over the parts, and the time of a solve like the parts.
inline const Range kSubsteps = whole(1, 4096);
inline const Range kPoints = whole(1, 10'000);
inline const Range kThreads = whole(0, 1024);
/// Powers of a cell's size stay within double precision.
inline const Range kExponent{"from 1 to 20", [](double x) { return x >= 1.0 && x <= 20.0; }};
/// Friction of an interface is between a strength (0) and a coefficient (1), or near them.
inline const Range kFrictionExponent{"above 0, at most 10", [](double x) { return x > 0.0 && x <= 10.0; }};
inline const Range kHurst{"above 0, at most 1", [](double x) { return x > 0.0 && x <= 1.0; }};
/// Whole numbers that TOML readers and double precision have alike; one more and its neighbour would be one.
inline const Range kSeeds = whole(0, 0x1p53 - 1.0);
Range inner_radius_below(double radius);
Range period_for(double longest);
Range shortest_for(double longest, double period);
/// A step's result stays in memory to the end: some ten kilobytes.
inline constexpr std::size_t kMaxSteps = 100'000;
Range cycles_of(std::size_t steps);
/// Each shape needs the memory of one field over the grid.
inline constexpr std::size_t kMaxShapes = 1000;

/// Throws InputError for a value that is not allowed. reader: of the scene's file, with which the error names
/// the place of the value; null: a program made the scene.
void validate(const Scene& scene, const SceneReader* reader);

}  // namespace slipstick::solver

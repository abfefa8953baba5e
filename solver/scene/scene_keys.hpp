#pragma once

#include <string>
#include <vector>

#include "solver/input/setting_key.hpp"
#include "solver/scene/scene.hpp"

/// Every key and word that a scene file may have.
namespace slipstick::solver {

/// The table that read_scene() reads by. Defaults are those of Scene and Surface.
const SettingKeys& scene_keys();

/// A number that some shapes require, and its place in Surface.
struct ShapeNumber {
  std::string name;  ///< of its key in [upper] and [[upper.shape]]
  std::string unit;
  Range allowed;
  std::string meaning;
  std::vector<Shape> shapes;
  double Surface::*own = nullptr;
  double Roughness::*rough = nullptr;  ///< where it is none of Surface's own

  bool belongs_to(Shape shape) const;
  template <typename Body>  // Surface, const or not
  auto& of(Body& surface) const {
    return own != nullptr ? surface.*own : surface.roughness.*rough;
  }
};
/// All of them: they are read, validated and made dimensionless by this table.
const std::vector<ShapeNumber>& shape_numbers();

inline const Words<Shape> kShapes{
    {"sphere", Shape::sphere},         {"ellipsoid", Shape::ellipsoid},         {"cone", Shape::cone},
    {"flat_punch", Shape::flat_punch}, {"rounded_punch", Shape::rounded_punch}, {"power", Shape::power},
    {"height_map", Shape::height_map}, {"roughness", Shape::roughness}};
/// Every law's word, and "none" for no layer.
const Words<const LawKind*>& layer_words();
inline const Words<Combine> kCombinations{{"sum", Combine::sum}, {"nearest", Combine::nearest}};
/// Each in m.
inline const Words<double> kHeightUnits{{"m", 1.0}, {"mm", 1e-3}, {"um", 1e-6}, {"nm", 1e-9}};
inline const Words<PressureModel> kPressureModels{{"solved", PressureModel::solved},
                                                  {"hertz", PressureModel::hertz},
                                                  {"hertz_averaged", PressureModel::hertz_averaged},
                                                  {"file", PressureModel::file}};
inline const Words<Coupling> kCouplings{{"auto", Coupling::automatic},
                                        {"none", Coupling::none},
                                        {"pressure", Coupling::pressure},
                                        {"full", Coupling::full}};
inline const Words<OperatorKind> kOperators{
    {"dcfft", OperatorKind::dcfft}, {"direct", OperatorKind::direct}, {"dense", OperatorKind::dense}};
inline const Words<Method> kMethods{{"coulomb", Method::coulomb},
                                    {"projected_gradient", Method::projected_gradient},
                                    {"paper", Method::paper}};
inline const Words<ModelChoice> kModels{
    {"auto", ModelChoice::automatic}, {"full", ModelChoice::full}, {"exact", ModelChoice::exact}};
inline const Words<CellTraction> kCellTractions{{"constant", CellTraction::constant},
                                                {"smooth", CellTraction::smooth}};

}  // namespace slipstick::solver

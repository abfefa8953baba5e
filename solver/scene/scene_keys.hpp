#pragma once

#include "solver/input/setting_key.hpp"
#include "solver/scene/scene.hpp"
#include "solver/scene/shape_kind.hpp"

/// Every key and word that a scene file may have.
namespace slipstick::solver {

/// The keys that read_scene() reads. Scene and Surface define their defaults.
const SettingKeys& scene_keys();

/// Every law's word, and "none" for no layer.
const Words<const LawKind*>& layer_words();
inline const Words<Combine> kCombinations{{"sum", Combine::sum}, {"nearest", Combine::nearest}};
/// Each in m.
inline const Words<double> kHeightUnits{{"m", 1.0}, {"mm", 1e-3}, {"um", 1e-6}, {"nm", 1e-9}};
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
inline const Words<CellTraction> kCellTractions{{"constant", CellTraction::constant},
                                                {"smooth", CellTraction::smooth}};

}  // namespace slipstick::solver

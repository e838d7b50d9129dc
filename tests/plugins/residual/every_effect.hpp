#pragma once

#include "model/joint_model.hpp"

/// The whole catalogue without a host, those named left out.
namespace bodeflow::residual::test {

Catalogue every_effect(const std::vector<std::string>& without = {});
std::vector<EffectDescription> every_description();

}  // namespace bodeflow::residual::test

#include <bodeflow/block.hpp>

#include "design_block.hpp"
#include "estimator_block.hpp"
#include "evaluation_block.hpp"
#include "known_response_block.hpp"
#include "nominal_design_block.hpp"
#include "reference_model_block.hpp"
#include "relay_block.hpp"
#include "rst_block.hpp"
#include "self_tuning_block.hpp"

using namespace bodeflow::adaptive_control;

BODEFLOW_PLUGIN("adaptive_control", "0.1.0", Estimator, Design, RstBlock, KnownResponse, ReferenceModel, Evaluation, Relay,
                SelfTuning, NominalDesign)

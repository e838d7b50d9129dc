#include <bodeflow/block.hpp>

#include "change_block.hpp"
#include "comparison_block.hpp"
#include "monte_carlo_block.hpp"
#include "true_model_block.hpp"
#include "truncation_block.hpp"

using namespace bodeflow::validation;

BODEFLOW_PLUGIN("validation", "0.1.0", ChangeBlock, ComparisonBlock, MonteCarlo, TrueModel, Truncation)

#pragma once

// Records: layout of the bytes, reading, checking foreign bytes, writing.
#include <bodeflow/record_builder.hpp>
#include <bodeflow/record_check.hpp>
#include <bodeflow/record_layout.hpp>
#include <bodeflow/record_view.hpp>

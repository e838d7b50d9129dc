// The layout of every struct of abi.h on 64-bit machines: a plugin that was built last year reads these bytes. Growing a struct
// at its end (with struct_size) is a deliberate change of the numbers here; anything else breaks plugins that exist.
#include <bodeflow/abi.h>

#include <cstddef>
#include <cstring>
#include <type_traits>

#include "catch.hpp"

#define SIZE(type, size) \
  static_assert(sizeof(type) == (size) && std::is_standard_layout_v<type> && std::is_trivially_copyable_v<type>)
#define AT(type, member, offset) static_assert(offsetof(type, member) == (offset))

static_assert(BF_ABI_MAJOR == 1 && BF_ABI_MINOR == 0);
static_assert(BF_OK == 0 && BF_FAILED == 1);
static_assert(BF_ANY == 0 && BF_F64 == 1 && BF_C64 == 2 && BF_I64 == 3 && BF_U8 == 4);
static_assert(BF_BOOL == 1 && BF_INTEGER == 2 && BF_NUMBER == 3 && BF_STRING == 4 && BF_CHOICE == 5 && BF_FILE == 6);
static_assert(BF_NUMBERS == 7 && BF_INTEGERS == 8 && BF_STRINGS == 9 && BF_COMPLEX_LIST == 10 && BF_MATRIX == 11);
static_assert(BF_STREAM == 1 && BF_MESSAGE == 2 && BF_IN == 1 && BF_OUT == 2 && BF_PORT_OPTIONAL == 1);
static_assert(BF_PARAMETER_REQUIRED == 1 && BF_PARAMETER_LIVE == 2 && BF_PARAMETER_EXCLUSIVE_MIN == 4 &&
              BF_PARAMETER_EXCLUSIVE_MAX == 8);
static_assert(BF_BLOCK_REALTIME_SAFE == 1 && BF_BLOCK_IN_PLACE == 2 && BF_BLOCK_ASYNCHRONOUS == 4);
static_assert(BF_FIT_LOGARITHMIC == 1 && BF_FIT_EACH_RECORD == 2);
static_assert(BF_ACTS_LAW == 1 && BF_ACTS_IMMITTANCE == 2 && BF_ACTS_INPUT == 3 && BF_ACTS_OUTPUT == 4 && BF_ACTS_SERIES == 5 &&
              BF_ACTS_PARALLEL == 6 && BF_ACTS_DELAY == 7 && BF_ACTS_TONE == 8);
static_assert(BF_EFFECT_ROUGH == 1 && BF_EFFECT_NONSTATIONARY == 2 && BF_EFFECT_MEMORYLESS_LINEAR == 4);
static_assert(BF_HOLD_ZERO_ORDER == 1 && BF_HOLD_FIRST_ORDER == 2 && BF_HOLD_BAND_LIMITED == 3);
static_assert(BF_BASE_STATE_SPACE == 1 && BF_BASE_LAWS == 2);
static_assert(BF_LOG_DEBUG == 0 && BF_LOG_INFO == 1 && BF_LOG_WARNING == 2 && BF_LOG_ERROR == 3);

SIZE(bf_rate, 16);
AT(bf_rate, num, 0);
AT(bf_rate, den, 8);

SIZE(bf_parameter_value, 56);
AT(bf_parameter_value, struct_size, 0);
AT(bf_parameter_value, type, 4);
AT(bf_parameter_value, given, 8);
AT(bf_parameter_value, rows, 12);
AT(bf_parameter_value, columns, 16);
AT(bf_parameter_value, integer, 24);
AT(bf_parameter_value, numbers, 32);
AT(bf_parameter_value, integers, 40);
AT(bf_parameter_value, strings, 48);

SIZE(bf_port_descriptor, 48);
AT(bf_port_descriptor, struct_size, 0);
AT(bf_port_descriptor, kind, 4);
AT(bf_port_descriptor, direction, 8);
AT(bf_port_descriptor, flags, 12);
AT(bf_port_descriptor, element, 16);
AT(bf_port_descriptor, name, 24);
AT(bf_port_descriptor, record_type, 32);
AT(bf_port_descriptor, doc, 40);

SIZE(bf_parameter_descriptor, 128);
AT(bf_parameter_descriptor, struct_size, 0);
AT(bf_parameter_descriptor, type, 4);
AT(bf_parameter_descriptor, flags, 8);
AT(bf_parameter_descriptor, choice_count, 12);
AT(bf_parameter_descriptor, name, 16);
AT(bf_parameter_descriptor, unit, 24);
AT(bf_parameter_descriptor, doc, 32);
AT(bf_parameter_descriptor, choices, 40);
AT(bf_parameter_descriptor, aliases, 48);
AT(bf_parameter_descriptor, minimum, 56);
AT(bf_parameter_descriptor, maximum, 64);
AT(bf_parameter_descriptor, fallback, 72);

SIZE(bf_block_descriptor, 80);
AT(bf_block_descriptor, struct_size, 0);
AT(bf_block_descriptor, flags, 4);
AT(bf_block_descriptor, port_count, 8);
AT(bf_block_descriptor, parameter_count, 12);
AT(bf_block_descriptor, id, 16);
AT(bf_block_descriptor, summary, 24);
AT(bf_block_descriptor, doc, 32);
AT(bf_block_descriptor, references, 40);
AT(bf_block_descriptor, roles, 48);
AT(bf_block_descriptor, cost_ns, 56);
AT(bf_block_descriptor, ports, 64);
AT(bf_block_descriptor, parameters, 72);

SIZE(bf_note, 24);
AT(bf_note, name, 0);
AT(bf_note, values, 8);
AT(bf_note, count, 16);

SIZE(bf_stream_facts, 88);
AT(bf_stream_facts, struct_size, 0);
AT(bf_stream_facts, known, 4);
AT(bf_stream_facts, element, 8);
AT(bf_stream_facts, channels, 12);
AT(bf_stream_facts, rate, 16);
AT(bf_stream_facts, length, 32);
AT(bf_stream_facts, unit, 40);
AT(bf_stream_facts, clock, 48);
AT(bf_stream_facts, channel_names, 56);
AT(bf_stream_facts, channel_units, 64);
AT(bf_stream_facts, notes, 72);
AT(bf_stream_facts, note_count, 80);

SIZE(bf_flow, 24);
AT(bf_flow, struct_size, 0);
AT(bf_flow, samples, 4);
AT(bf_flow, delay, 8);
AT(bf_flow, initial, 16);

SIZE(bf_resolution, 48);
AT(bf_resolution, struct_size, 0);
AT(bf_resolution, input_count, 4);
AT(bf_resolution, output_count, 8);
AT(bf_resolution, inputs, 16);
AT(bf_resolution, outputs, 24);
AT(bf_resolution, input_flows, 32);
AT(bf_resolution, output_flows, 40);

SIZE(bf_record, 16);
AT(bf_record, bytes, 0);
AT(bf_record, size, 8);

SIZE(bf_host, 64);
AT(bf_host, struct_size, 0);
AT(bf_host, abi_major, 4);
AT(bf_host, abi_minor, 8);
AT(bf_host, context, 16);
AT(bf_host, error, 24);
AT(bf_host, extension, 32);
AT(bf_host, record_create, 40);
AT(bf_host, record_retain, 48);
AT(bf_host, record_release, 56);

SIZE(bf_log, 16);
AT(bf_log, write, 8);
SIZE(bf_files, 24);
AT(bf_files, note_input, 8);
AT(bf_files, output_path, 16);

SIZE(bf_advice, 16);
AT(bf_advice, advise, 8);

SIZE(bf_numbers, 16);
AT(bf_numbers, values, 0);
AT(bf_numbers, count, 8);

SIZE(bf_fit_parameter, 56);
AT(bf_fit_parameter, struct_size, 0);
AT(bf_fit_parameter, flags, 4);
AT(bf_fit_parameter, name, 8);
AT(bf_fit_parameter, unit, 16);
AT(bf_fit_parameter, doc, 24);
AT(bf_fit_parameter, low, 32);
AT(bf_fit_parameter, high, 40);
AT(bf_fit_parameter, scale, 48);

SIZE(bf_place, 80);
AT(bf_place, struct_size, 0);
AT(bf_place, name, 8);
AT(bf_place, kind, 16);
AT(bf_place, flow_unit, 24);
AT(bf_place, stored_unit, 32);
AT(bf_place, reaction_unit, 40);
AT(bf_place, coefficient, 48);
AT(bf_place, flow, 56);
AT(bf_place, stored, 64);
AT(bf_place, effort, 72);

SIZE(bf_signals, 40);
AT(bf_signals, flow, 0);
AT(bf_signals, stored, 8);
AT(bf_signals, time_s, 16);
AT(bf_signals, step_s, 24);
AT(bf_signals, gain, 32);

SIZE(bf_reaction, 24);
AT(bf_reaction, value, 0);
AT(bf_reaction, by_flow, 8);
AT(bf_reaction, by_stored, 16);

SIZE(bf_answer, 64);
AT(bf_answer, struct_size, 0);
AT(bf_answer, context, 8);
AT(bf_answer, error, 16);
AT(bf_answer, text, 24);
AT(bf_answer, values, 32);
AT(bf_answer, parameter, 40);
AT(bf_answer, place, 48);
AT(bf_answer, input, 56);

SIZE(bf_effect_descriptor, 88);
AT(bf_effect_descriptor, struct_size, 0);
AT(bf_effect_descriptor, flags, 4);
AT(bf_effect_descriptor, acts, 8);
AT(bf_effect_descriptor, steps_per_sample, 12);
AT(bf_effect_descriptor, memory, 16);
AT(bf_effect_descriptor, kind_count, 24);
AT(bf_effect_descriptor, equivalent_count, 28);
AT(bf_effect_descriptor, id, 32);
AT(bf_effect_descriptor, summary, 40);
AT(bf_effect_descriptor, doc, 48);
AT(bf_effect_descriptor, references, 56);
AT(bf_effect_descriptor, separation, 64);
AT(bf_effect_descriptor, kinds, 72);
AT(bf_effect_descriptor, equivalents, 80);

SIZE(bf_situation, 192);
AT(bf_situation, struct_size, 0);
AT(bf_situation, input_unit, 8);
AT(bf_situation, output_unit, 16);
AT(bf_situation, sample_time_s, 24);
AT(bf_situation, duration_s, 32);
AT(bf_situation, input_peak, 40);
AT(bf_situation, input_rms, 48);
AT(bf_situation, output_peak, 56);
AT(bf_situation, output_rms, 64);
AT(bf_situation, residual_mean, 72);
AT(bf_situation, residual_rms, 80);
AT(bf_situation, place, 88);
AT(bf_situation, line_hz, 96);
AT(bf_situation, response, 112);
AT(bf_situation, missing, 128);
AT(bf_situation, missing_std, 144);
AT(bf_situation, peaks_hz, 160);
AT(bf_situation, jumps_s, 176);

SIZE(bf_effect, 96);
AT(bf_effect, struct_size, 0);
AT(bf_effect, self, 8);
AT(bf_effect, refuses, 16);
AT(bf_effect, parameters, 24);
AT(bf_effect, starts, 32);
AT(bf_effect, sentence, 40);
AT(bf_effect, react, 48);
AT(bf_effect, map, 56);
AT(bf_effect, transfer, 64);
AT(bf_effect, delay_s, 72);
AT(bf_effect, tones_hz, 80);
AT(bf_effect, destroy, 88);

SIZE(bf_base_facts, 32);
AT(bf_base_facts, struct_size, 0);
AT(bf_base_facts, flags, 4);
AT(bf_base_facts, hold, 8);
AT(bf_base_facts, delay_s, 16);
AT(bf_base_facts, filter_hz, 24);

SIZE(bf_linear_plant, 128);
AT(bf_linear_plant, struct_size, 0);
AT(bf_linear_plant, states, 4);
AT(bf_linear_plant, inputs, 8);
AT(bf_linear_plant, places, 12);
AT(bf_linear_plant, resize, 16);
AT(bf_linear_plant, context, 24);
AT(bf_linear_plant, A, 32);
AT(bf_linear_plant, B, 40);
AT(bf_linear_plant, E, 48);
AT(bf_linear_plant, Cf, 56);
AT(bf_linear_plant, Df, 64);
AT(bf_linear_plant, Ff, 72);
AT(bf_linear_plant, Cs, 80);
AT(bf_linear_plant, Ds, 88);
AT(bf_linear_plant, Fs, 96);
AT(bf_linear_plant, C, 104);
AT(bf_linear_plant, D, 112);
AT(bf_linear_plant, F, 120);

SIZE(bf_measured_response, 72);
AT(bf_measured_response, struct_size, 0);
AT(bf_measured_response, frequency_hz, 8);
AT(bf_measured_response, response, 24);
AT(bf_measured_response, weight, 40);
AT(bf_measured_response, known, 56);

SIZE(bf_base_model, 128);
AT(bf_base_model, struct_size, 0);
AT(bf_base_model, self, 8);
AT(bf_base_model, configure, 16);
AT(bf_base_model, use_model, 24);
AT(bf_base_model, facts, 32);
AT(bf_base_model, parameters, 40);
AT(bf_base_model, places, 48);
AT(bf_base_model, known, 56);
AT(bf_base_model, inputs, 64);
AT(bf_base_model, response_unit, 72);
AT(bf_base_model, conventions, 80);
AT(bf_base_model, starts, 88);
AT(bf_base_model, state_space, 96);
AT(bf_base_model, response, 104);
AT(bf_base_model, react, 112);
AT(bf_base_model, destroy, 120);

SIZE(bf_parts, 24);
AT(bf_parts, list, 8);
AT(bf_parts, create, 16);

SIZE(bf_activation, 48);
AT(bf_activation, struct_size, 0);
AT(bf_activation, realtime, 4);
AT(bf_activation, max_count, 8);
AT(bf_activation, seed, 16);
AT(bf_activation, rate, 24);
AT(bf_activation, vector_level, 40);

SIZE(bf_stream, 32);
AT(bf_stream, channels, 0);
AT(bf_stream, offset, 8);
AT(bf_stream, count, 16);
AT(bf_stream, channel_count, 24);
AT(bf_stream, element, 28);

SIZE(bf_message, 24);
AT(bf_message, port, 0);
AT(bf_message, time, 8);
AT(bf_message, record, 16);

SIZE(bf_process, 72);
AT(bf_process, struct_size, 0);
AT(bf_process, message_count, 4);
AT(bf_process, messages, 8);
AT(bf_process, inputs, 16);
AT(bf_process, outputs, 24);
AT(bf_process, position, 32);
AT(bf_process, count, 40);
AT(bf_process, done, 48);
AT(bf_process, context, 56);
AT(bf_process, emit, 64);

SIZE(bf_block, 96);
AT(bf_block, struct_size, 0);
AT(bf_block, self, 8);
AT(bf_block, configure, 16);
AT(bf_block, resolve, 24);
AT(bf_block, activate, 32);
AT(bf_block, process, 40);
AT(bf_block, change, 48);
AT(bf_block, finish, 56);
AT(bf_block, reset, 64);
AT(bf_block, deactivate, 72);
AT(bf_block, destroy, 80);
AT(bf_block, extension, 88);

SIZE(bf_factory, 40);
AT(bf_factory, struct_size, 0);
AT(bf_factory, kind, 8);
AT(bf_factory, id, 16);
AT(bf_factory, descriptor, 24);
AT(bf_factory, create, 32);

SIZE(bf_plugin, 56);
AT(bf_plugin, magic, 0);
AT(bf_plugin, abi_major, 8);
AT(bf_plugin, abi_minor, 12);
AT(bf_plugin, struct_size, 16);
AT(bf_plugin, name, 24);
AT(bf_plugin, version, 32);
AT(bf_plugin, build, 40);
AT(bf_plugin, factories, 48);

SIZE(bf_elf_note, 144);
AT(bf_elf_note, magic, 0);
AT(bf_elf_note, abi_major, 8);
AT(bf_elf_note, abi_minor, 12);
AT(bf_elf_note, name, 16);
AT(bf_elf_note, version, 64);
AT(bf_elf_note, build, 80);

TEST_CASE("the magic number of a plugin spells BODEFLOW in the file") {
  const std::uint64_t magic = BF_PLUGIN_MAGIC;
  CHECK(std::memcmp(&magic, "BODEFLOW", 8) == 0);
}

extern "C" int bodeflow_sizes_in_c(std::size_t* sizes);

TEST_CASE("a C compiler sees the structs of the border in the same sizes") {
  std::size_t sizes[33] = {};
  REQUIRE(bodeflow_sizes_in_c(sizes) == 33);
  const std::size_t expected[33] = {sizeof(bf_rate),
                                    sizeof(bf_parameter_value),
                                    sizeof(bf_port_descriptor),
                                    sizeof(bf_parameter_descriptor),
                                    sizeof(bf_block_descriptor),
                                    sizeof(bf_flow),
                                    sizeof(bf_note),
                                    sizeof(bf_stream_facts),
                                    sizeof(bf_resolution),
                                    sizeof(bf_record),
                                    sizeof(bf_host),
                                    sizeof(bf_log),
                                    sizeof(bf_files),
                                    sizeof(bf_advice),
                                    sizeof(bf_activation),
                                    sizeof(bf_process),
                                    sizeof(bf_block),
                                    sizeof(bf_factory),
                                    sizeof(bf_plugin),
                                    sizeof(bf_elf_note),
                                    sizeof(bf_fit_parameter),
                                    sizeof(bf_place),
                                    sizeof(bf_signals),
                                    sizeof(bf_reaction),
                                    sizeof(bf_answer),
                                    sizeof(bf_effect_descriptor),
                                    sizeof(bf_situation),
                                    sizeof(bf_effect),
                                    sizeof(bf_base_facts),
                                    sizeof(bf_linear_plant),
                                    sizeof(bf_measured_response),
                                    sizeof(bf_base_model),
                                    sizeof(bf_parts)};
  CHECK(std::memcmp(sizes, expected, sizeof sizes) == 0);
}

/* abi.h as a C compiler reads it. */
#include <bodeflow/abi.h>
#include <stddef.h>
#include <string.h>

/* Writes the sizes of the structs, returns how many. */
int bodeflow_sizes_in_c(size_t* sizes) {
  const size_t all[] = {sizeof(bf_rate),
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
  memcpy(sizes, all, sizeof all);
  return (int)(sizeof all / sizeof all[0]);
}

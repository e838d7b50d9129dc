/* A plugin of the year of ABI 1.0: it is never changed and never built against another header than abi_1_0.h beside it. Every
 * bodeflow with ABI 1.x must load it and give the numbers of pinned_test.cpp. Each function of the border is used at least once.
 */
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "abi_1_0.h"

#define COUNT(list) ((uint32_t)(sizeof(list) / sizeof((list)[0])))
#define EXPORT __attribute__((visibility("default")))

static int32_t fail(const bf_host* host, const char* why) { return host->error(host, why), BF_FAILED; }

/* ---- records: their bytes as <bodeflow/record_layout.hpp> of 1.0 tells them ------------------------------------- */

typedef struct text_at {
  uint64_t offset;
  uint32_t length, reserved;
} text_at;

typedef struct record_header {
  char magic[4];
  uint32_t version;
  uint64_t size;
  uint32_t attribute_count, array_count;
  uint64_t attributes, arrays;
  text_at type;
  uint64_t reserved;
} record_header;

typedef struct record_attribute {
  text_at name;
  uint32_t kind, list;
  uint64_t count, values, reserved;
} record_attribute;

typedef struct record_array {
  text_at name, unit;
  uint32_t element, rank;
  uint64_t data, bytes, shape[8], reserved;
} record_array;

/* One attribute "value", and an array "sums" of `channels` complex numbers in volts where there is one. */
typedef struct small_record {
  record_header header;
  record_attribute attribute;
  record_array array;
  double value;
  char type[24], value_name[8], sums_name[8], unit[8];
  char to_64[24];
  double sums[8];
} small_record;
_Static_assert(offsetof(small_record, sums) % 64 == 0 && sizeof(small_record) % 64 == 0, "as records are laid out");

static bf_record* record_of(const bf_host* host, const char* type, double value, const double* sums, uint32_t channels) {
  bf_record* made = host->record_create(host, sizeof(small_record));
  if (made == NULL) return NULL;
  small_record* r = (small_record*)made->bytes;
#define AT(member) offsetof(small_record, member)
  r->header = (record_header){
      {'B', 'F', 'R', '1'}, 1, sizeof *r, 1, sums != NULL, AT(attribute), AT(array), {AT(type), (uint32_t)strlen(type), 0}, 0};
  if (sums == NULL) r->header.arrays = 0;
  strcpy(r->type, type);
  strcpy(r->value_name, "value");
  r->attribute = (record_attribute){{AT(value_name), 5, 0}, 3, 0, 1, AT(value), 0};
  r->value = value;
  if (sums != NULL) {
    strcpy(r->sums_name, "sums");
    strcpy(r->unit, "V");
    r->array = (record_array){{AT(sums_name), 4, 0}, {AT(unit), 1, 0}, BF_C64, 1, AT(sums), 16 * channels, {channels}, 0};
    memcpy(r->sums, sums, 16 * channels);
  }
  return made;
}

/* The attribute "value" of a record of any layout; 0 where it has none. */
static double value_of(const bf_record* record) {
  const record_header* header = (const record_header*)record->bytes;
  for (uint32_t i = 0; i < header->attribute_count; ++i) {
    const record_attribute* a = (const record_attribute*)(record->bytes + header->attributes) + i;
    if (a->kind == 3 && a->name.length == 5 && memcmp(record->bytes + a->name.offset, "value", 5) == 0)
      return *(const double*)(record->bytes + a->values);
  }
  return 0.0;
}

/* ---- what the blocks share -------------------------------------------------------------------------------------- */

typedef struct block {
  const bf_host* host;
  double gain, configured_gain, offset, initial[16];
  uint64_t length, at;
  double sums[8], samples;
  uint32_t channels;
  FILE* file;
} block;

static double* samples_of(const bf_stream* s, uint32_t channel) {
  return (double*)s->channels[channel] + s->offset * (s->element == BF_C64 ? 2 : 1);
}
static int32_t no_configure(void* self, const bf_parameter_value* v, uint32_t n) { return (void)self, (void)v, (void)n, BF_OK; }
static int32_t no_activate(void* self, const bf_activation* a) { return (void)self, (void)a, BF_OK; }
static int32_t no_change(void* self, uint32_t p, const bf_parameter_value* v) { return (void)self, (void)p, (void)v, BF_OK; }
static int32_t no_finish(void* self, bf_process* p) { return (void)self, (void)p, BF_OK; }
static int32_t no_reset(void* self) { return (void)self, BF_OK; }
static void no_deactivate(void* self) { (void)self; }
static const void* no_extension(void* self, const char* id) { return (void)self, (void)id, NULL; }
static int32_t same_facts(void* self, bf_resolution* r) {
  (void)self;
  r->outputs[0] = r->inputs[0];
  return BF_OK;
}

static bf_block plain_block(const bf_host* host) {
  block* self = calloc(1, sizeof *self);
  if (self != NULL) self->host = host;
  return (bf_block){sizeof(bf_block), 0,         self,     no_configure,  same_facts, no_activate, NULL,
                    no_change,        no_finish, no_reset, no_deactivate, free,       no_extension};
}
static int32_t give(const bf_host* host, void* made, bf_block block) {
  if (block.self == NULL) return fail(host, "no memory");
  memcpy(made, &block, sizeof block);
  return BF_OK;
}

#define STREAM(direction, element, name) \
  { sizeof(bf_port_descriptor), BF_STREAM, direction, 0, element, name, NULL, "" }
#define MESSAGE(direction, name, type) \
  { sizeof(bf_port_descriptor), BF_MESSAGE, direction, 0, BF_ANY, name, type, "" }
#define PARAMETER(type, flags, name, unit, low, high, ...)                                               \
  {                                                                                                      \
    sizeof(bf_parameter_descriptor), type, flags, 0, name, unit, "of the test", NULL, NULL, low, high, { \
      sizeof(bf_parameter_value), type, 0, __VA_ARGS__                                                   \
    }                                                                                                    \
  }
#define INFINITE __builtin_inf()

static const bf_port_descriptor in = STREAM(BF_IN, BF_F64, "in"), out = STREAM(BF_OUT, BF_F64, "out");

/* ---- pinned.ramp: two channels n and -n, and a mark every hundred samples ---------------------------------------- */

static const bf_port_descriptor marks = MESSAGE(BF_OUT, "marks", "pinned_mark");
static const bf_port_descriptor* const ramp_ports[] = {&out, &marks};
static const bf_parameter_descriptor length =
    PARAMETER(BF_INTEGER, BF_PARAMETER_REQUIRED, "length", "1", 1, 1e6, 0, 0, 0, NULL, NULL, NULL);
static const bf_parameter_descriptor* const ramp_parameters[] = {&length};
static const bf_block_descriptor ramp = {
    sizeof ramp, BF_BLOCK_REALTIME_SAFE, 2, 1, "pinned.ramp", "Counts.", "", "", "source", 1.0, ramp_ports, ramp_parameters};

static int32_t ramp_configure(void* self, const bf_parameter_value* values, uint32_t count) {
  if (count != 1 || values[0].given != 1) return fail(((block*)self)->host, "no length");
  ((block*)self)->length = (uint64_t)values[0].integer;
  return BF_OK;
}
static int32_t ramp_resolve(void* self, bf_resolution* r) {
  static const char* const names[] = {"up", "down"};
  static const char* const units[] = {"V", "V"};
  static const double period[] = {0.25};
  static const bf_note note = {"excitation.period", period, 1};
  (void)self;
  r->outputs[0] = (bf_stream_facts){sizeof(bf_stream_facts), 1, BF_F64, 2, {1000, 1}, -1, "V", "", names, units, &note, 1};
  return BF_OK;
}
static int32_t ramp_process(void* self, bf_process* p) {
  block* b = self;
  const uint64_t left = b->length - b->at;
  if (left < p->count) p->done = left;
  for (uint64_t n = 0; n < p->done; ++n) {
    samples_of(&p->outputs[0], 0)[n] = (double)(p->position + n);
    samples_of(&p->outputs[0], 1)[n] = -(double)(p->position + n);
    if ((p->position + n) % 100 != 0) continue;
    bf_record* mark = record_of(b->host, "pinned_mark", (double)(p->position + n), NULL, 0);
    if (mark == NULL) return fail(b->host, "no memory");
    p->emit(p, 0, mark, n);
  }
  b->at += p->done;
  return BF_OK;
}
static int32_t ramp_reset(void* self) { return ((block*)self)->at = 0, BF_OK; }
static int32_t ramp_activate(void* self, const bf_activation* a) { return (void)a, ramp_reset(self); }
static int32_t ramp_create(const bf_factory* factory, const bf_host* host, void* made) {
  (void)factory;
  bf_block c = plain_block(host);
  c.configure = ramp_configure, c.resolve = ramp_resolve, c.process = ramp_process, c.reset = ramp_reset,
  c.activate = ramp_activate;
  return give(host, made, c);
}

/* ---- pinned.scale: y = gain x + the value of the last mark; a parameter of every type ---------------------------- */

static const double two_and_a_half = 2.5, list[] = {1.5, -2.0}, matrix[] = {1, 2, 3, 4, 5, 6}, complex_list[] = {1, -1, 0.5, 2};
static const int64_t integers[] = {3, 5, 8};
static const char *const texts[] = {"one", "two"}, *const word[] = {"calm"}, *const words[] = {"calm", "wild"},
                         *const name[] = {"pinned"};
static const bf_port_descriptor mark_in = MESSAGE(BF_IN, "mark", NULL);
static const bf_port_descriptor* const scale_ports[] = {&in, &out, &mark_in};
static const bf_parameter_descriptor scale_all[] = {
    PARAMETER(BF_NUMBER, BF_PARAMETER_LIVE | BF_PARAMETER_EXCLUSIVE_MIN, "gain", "1", 0, 1e3, 1, 1, 0, &two_and_a_half, NULL,
              NULL),
    PARAMETER(BF_BOOL, 0, "flag", "", -INFINITE, INFINITE, 1, 1, 1, NULL, NULL, NULL),
    PARAMETER(BF_INTEGER, 0, "count", "1", 0, 9, 1, 1, 7, NULL, NULL, NULL),
    PARAMETER(BF_STRING, 0, "name", "", -INFINITE, INFINITE, 1, 1, 0, NULL, NULL, name),
    {sizeof(bf_parameter_descriptor),
     BF_CHOICE,
     0,
     2,
     "mood",
     "",
     "of the test",
     words,
     "temper",
     -INFINITE,
     INFINITE,
     {sizeof(bf_parameter_value), BF_CHOICE, 0, 1, 1, 0, NULL, NULL, word}},
    PARAMETER(BF_FILE, 0, "file", "", -INFINITE, INFINITE, 0, 0, 0, NULL, NULL, NULL),
    PARAMETER(BF_NUMBERS, 0, "group.times", "s", -INFINITE, INFINITE, 2, 1, 0, list, NULL, NULL),
    PARAMETER(BF_INTEGERS, 0, "group.integers", "1", -INFINITE, INFINITE, 3, 1, 0, NULL, integers, NULL),
    PARAMETER(BF_STRINGS, 0, "texts", "", -INFINITE, INFINITE, 2, 1, 0, NULL, NULL, texts),
    PARAMETER(BF_COMPLEX_LIST, 0, "complex", "1", -INFINITE, INFINITE, 2, 1, 0, complex_list, NULL, NULL),
    PARAMETER(BF_MATRIX, 0, "matrix", "1", -INFINITE, INFINITE, 2, 3, 0, matrix, NULL, NULL)};
static const bf_parameter_descriptor* const scale_parameters[] = {&scale_all[0], &scale_all[1], &scale_all[2], &scale_all[3],
                                                                  &scale_all[4], &scale_all[5], &scale_all[6], &scale_all[7],
                                                                  &scale_all[8], &scale_all[9], &scale_all[10]};
static const bf_block_descriptor scale = {sizeof scale,
                                          BF_BLOCK_REALTIME_SAFE | BF_BLOCK_IN_PLACE,
                                          3,
                                          11,
                                          "pinned.scale",
                                          "Scales.",
                                          "",
                                          "",
                                          "filter",
                                          1.0,
                                          scale_ports,
                                          scale_parameters};

static int32_t scale_configure(void* self, const bf_parameter_value* v, uint32_t count) {
  block* b = self;
  char line[512];
  const bf_log* log = b->host->extension(b->host, BF_EXTENSION_LOG);
  const bf_files* files = b->host->extension(b->host, BF_EXTENSION_FILES);
  if (count != 11 || log == NULL || files == NULL) return fail(b->host, "not what 1.0 promises");
  b->gain = b->configured_gain = v[0].numbers[0];
  if (v[5].rows == 1 && files->note_input(b->host, v[5].strings[0]) != BF_OK) return BF_FAILED;
  if (v[6].rows == 0 || v[7].rows == 0 || v[8].rows == 0 || v[9].rows < 2 || v[10].rows == 0)
    return fail(b->host, "too few values");
  snprintf(line, sizeof line,
           "flag %d count %d name %s mood %s times %g %g integers %d %d texts %s %s complex %g%+gi %g%+gi matrix %ux%u %g",
           (int)v[1].integer, (int)v[2].integer, v[3].strings[0], v[4].strings[0], v[6].numbers[0], v[6].numbers[v[6].rows - 1],
           (int)v[7].integers[0], (int)v[7].integers[v[7].rows - 1], v[8].strings[0], v[8].strings[v[8].rows - 1],
           v[9].numbers[0], v[9].numbers[1], v[9].numbers[2], v[9].numbers[3], v[10].rows, v[10].columns,
           v[10].numbers[v[10].rows * v[10].columns - 1]);
  log->write(b->host, BF_LOG_INFO, line);
  return BF_OK;
}
static int32_t scale_change(void* self, uint32_t parameter, const bf_parameter_value* value) {
  if (parameter != 0) return fail(((block*)self)->host, "not a live parameter");
  ((block*)self)->gain = value->numbers[0];
  return BF_OK;
}
static int32_t scale_process(void* self, bf_process* p) {
  block* b = self;
  for (uint32_t i = 0; i < p->message_count; ++i) b->offset = value_of(p->messages[i].record);
  for (uint32_t c = 0; c < p->inputs[0].channel_count; ++c)
    for (uint64_t n = 0; n < p->count; ++n)
      samples_of(&p->outputs[0], c)[n] = b->gain * samples_of(&p->inputs[0], c)[n] + b->offset;
  return BF_OK;
}
static int32_t scale_reset(void* self) {
  block* b = self;
  b->gain = b->configured_gain;
  return b->offset = 0.0, BF_OK;
}
static int32_t scale_create(const bf_factory* factory, const bf_host* host, void* made) {
  (void)factory;
  bf_block c = plain_block(host);
  c.configure = scale_configure, c.change = scale_change, c.process = scale_process, c.reset = scale_reset;
  return give(host, made, c);
}

/* ---- pinned.delay: two samples later, 7 and 8 before ------------------------------------------------------------- */

static const bf_port_descriptor* const delay_ports[] = {&in, &out};
static const bf_block_descriptor delay = {
    sizeof delay, BF_BLOCK_REALTIME_SAFE, 2, 0, "pinned.delay", "Delays.", "", "", "", 1.0, delay_ports, NULL};

static int32_t delay_resolve(void* self, bf_resolution* r) {
  block* b = self;
  r->outputs[0] = r->inputs[0];
  for (uint32_t c = 0; c < r->inputs[0].channels && c < 8; ++c) b->initial[2 * c] = 7, b->initial[2 * c + 1] = 8;
  r->input_flows[0].delay = 2;
  r->input_flows[0].initial = b->initial;
  return BF_OK;
}
static int32_t delay_process(void* self, bf_process* p) {
  (void)self;
  for (uint32_t c = 0; c < p->inputs[0].channel_count; ++c)
    memcpy(samples_of(&p->outputs[0], c), samples_of(&p->inputs[0], c), p->count * sizeof(double));
  return BF_OK;
}
static int32_t delay_create(const bf_factory* factory, const bf_host* host, void* made) {
  (void)factory;
  bf_block c = plain_block(host);
  c.resolve = delay_resolve, c.process = delay_process;
  return give(host, made, c);
}

/* ---- pinned.pair: two samples become one complex sample ----------------------------------------------------------- */

static const bf_port_descriptor pairs = STREAM(BF_OUT, BF_C64, "out");
static const bf_port_descriptor* const pair_ports[] = {&in, &pairs};
static const bf_block_descriptor pair = {
    sizeof pair, BF_BLOCK_REALTIME_SAFE, 2, 0, "pinned.pair", "Pairs.", "", "", "", 1.0, pair_ports, NULL};

static int32_t pair_resolve(void* self, bf_resolution* r) {
  (void)self;
  r->outputs[0] = r->inputs[0];
  r->outputs[0].element = BF_C64;
  r->outputs[0].rate.den *= 2;
  if (r->outputs[0].length >= 0) r->outputs[0].length /= 2;
  r->input_flows[0].samples = 2;
  return BF_OK;
}
static int32_t pair_process(void* self, bf_process* p) {
  (void)self;
  for (uint32_t c = 0; c < p->inputs[0].channel_count; ++c)
    memcpy(samples_of(&p->outputs[0], c), samples_of(&p->inputs[0], c), 2 * p->count * sizeof(double));
  return BF_OK;
}
static int32_t pair_create(const bf_factory* factory, const bf_host* host, void* made) {
  (void)factory;
  bf_block c = plain_block(host);
  c.resolve = pair_resolve, c.process = pair_process;
  return give(host, made, c);
}

/* ---- pinned.sum: at the end a record, and a file ------------------------------------------------------------------ */

static const bf_port_descriptor complex_in = STREAM(BF_IN, BF_C64, "in");
static const bf_port_descriptor totals = MESSAGE(BF_OUT, "totals", "pinned_totals");
static const bf_port_descriptor* const sum_ports[] = {&complex_in, &totals};
static const bf_block_descriptor sum = {sizeof sum, 0, 2, 0, "pinned.sum", "Sums.", "", "", "sink", 1.0, sum_ports, NULL};

static int32_t sum_resolve(void* self, bf_resolution* r) { return (void)r, (void)self, BF_OK; }
static int32_t sum_reset(void* self) {
  block* b = self;
  memset(b->sums, 0, sizeof b->sums);
  return b->samples = 0.0, BF_OK;
}
static int32_t sum_activate(void* self, const bf_activation* a) {
  block* b = self;
  const bf_files* files = b->host->extension(b->host, BF_EXTENSION_FILES);
  const char* path = files->output_path(b->host, "pinned.txt");
  sum_reset(self);
  if (path == NULL) return BF_FAILED;
  b->file = *path == '\0' ? NULL : fopen(path, "w");
  if (b->file != NULL) fprintf(b->file, "%d/%d Hz\n", (int)a->rate.num, (int)a->rate.den);
  return BF_OK;
}
static int32_t sum_process(void* self, bf_process* p) {
  block* b = self;
  b->channels = p->inputs[0].channel_count < 4 ? p->inputs[0].channel_count : 4;
  for (uint32_t c = 0; c < b->channels; ++c)
    for (uint64_t n = 0; n < 2 * p->count; ++n) b->sums[2 * c + n % 2] += samples_of(&p->inputs[0], c)[n];
  b->samples += (double)p->count;
  return BF_OK;
}
static int32_t sum_finish(void* self, bf_process* p) {
  block* b = self;
  bf_record* record = record_of(b->host, "pinned_totals", b->samples, b->sums, b->channels);
  if (record == NULL) return fail(b->host, "no memory");
  b->host->record_retain(b->host, record); /* one more count, given back at once */
  b->host->record_release(b->host, record);
  p->emit(p, 0, record, 0);
  return BF_OK;
}
static void sum_deactivate(void* self) {
  block* b = self;
  if (b->file != NULL) fclose(b->file);
  b->file = NULL;
}
static int32_t sum_advise(void* self, const bf_resolution* r, void* context, void (*tell)(void*, int32_t, const char*)) {
  char text[96];
  (void)self;
  snprintf(text, sizeof text, "sums %u channels in %s, period %g s", r->inputs[0].channels, r->inputs[0].unit,
           r->inputs[0].note_count == 1 ? r->inputs[0].notes[0].values[0] : 0.0);
  return tell(context, BF_LOG_WARNING, text), BF_OK;
}
static const bf_advice advice = {sizeof advice, sum_advise};
static const void* sum_extension(void* self, const char* id) {
  return (void)self, strcmp(id, BF_EXTENSION_ADVICE) == 0 ? &advice : NULL;
}
static int32_t sum_create(const bf_factory* factory, const bf_host* host, void* made) {
  (void)factory;
  bf_block c = plain_block(host);
  c.resolve = sum_resolve, c.activate = sum_activate, c.process = sum_process, c.finish = sum_finish, c.reset = sum_reset;
  c.deactivate = sum_deactivate, c.extension = sum_extension;
  return give(host, made, c);
}

/* ---- pinned.drag: an effect, a law in a bearing ------------------------------------------------------------------- */

static const char* const bearing[] = {"bearing"};
static const bf_effect_descriptor drag = {sizeof drag,   BF_EFFECT_ROUGH, BF_ACTS_LAW, 2,  1,  1,       0,
                                          "pinned.drag", "Brakes.",       "",          "", "", bearing, NULL};

static int32_t drag_refuses(void* self, const bf_situation* s, const bf_answer* a) {
  (void)self;
  if (s->input_peak > 100.0) a->text(a->context, "the input is too large");
  return BF_OK;
}
static int32_t drag_parameters(void* self, const bf_situation* s, const bf_answer* a) {
  const bf_fit_parameter drag_of = {sizeof drag_of, BF_FIT_LOGARITHMIC, "drag", s->place->reaction_unit, "", 0.0, INFINITE, 1.0};
  (void)self;
  return a->parameter(a->context, &drag_of), BF_OK;
}
static int32_t drag_starts(void* self, const bf_situation* s, const bf_answer* a) {
  const double small[] = {0.5}, lines[] = {(double)s->line_hz.count};
  (void)self;
  a->values(a->context, small, 1);
  return a->values(a->context, lines, 1), BF_OK;
}
static int32_t drag_sentence(void* self, const bf_numbers* value, const bf_numbers* std, const bf_situation* s,
                             const bf_answer* a) {
  char text[128];
  (void)self, (void)std;
  snprintf(text, sizeof text, "drag of %g %s at the %s", value->values[0], s->place->reaction_unit, s->place->name);
  return a->text(a->context, text), BF_OK;
}
static void drag_react(void* self, const double* p, const bf_signals* s, const double* memory, double* next, bf_reaction* r) {
  (void)self;
  *next = *memory + s->step_s;
  *r = (bf_reaction){p[0] * s->flow, p[0], 0.0};
}
static double drag_map(void* self, const double* p, double x, double t, double* m) {
  return (void)self, (void)p, (void)t, (void)m, x;
}
static void drag_transfer(void* self, const double* p, double re, double im, double* z) {
  (void)self, (void)re, (void)im, z[0] = p[0], z[1] = 0.0;
}
static double drag_delay(void* self, const double* p) { return (void)self, p[0]; }
static int32_t drag_tones(void* self, const double* p, const bf_answer* a) {
  return (void)self, a->values(a->context, p, 1), BF_OK;
}
static void nothing_to_destroy(void* self) { (void)self; }
static int32_t drag_create(const bf_factory* factory, const bf_host* host, void* made) {
  const bf_effect c = {sizeof c,   0,        NULL,          drag_refuses, drag_parameters, drag_starts,       drag_sentence,
                       drag_react, drag_map, drag_transfer, drag_delay,   drag_tones,      nothing_to_destroy};
  (void)factory, (void)host;
  memcpy(made, &c, sizeof c);
  return BF_OK;
}

/* ---- pinned.cart: a base model, a mass on one rail ------------------------------------------------------------------ */

static const double quarter_ms = 250e-6;
static const bf_parameter_descriptor cart_delay = PARAMETER(BF_NUMBER, 0, "delay", "s", 0, 1, 1, 1, 0, &quarter_ms, NULL, NULL);
static const bf_parameter_descriptor* const cart_parameters[] = {&cart_delay};
static const bf_block_descriptor cart = {sizeof cart, 0,  0,  1,   "pinned.cart", "A mass on a rail.",
                                         "",          "", "", 0.0, NULL,          cart_parameters};

static int32_t cart_configure(void* self, const bf_parameter_value* v, uint32_t count, const bf_answer* a) {
  if (count != 1) return a->error(a->context, "one parameter is described"), BF_FAILED;
  return *(double*)self = v[0].numbers[0], BF_OK;
}
static int32_t cart_use(void* self, const bf_record* r, const bf_answer* a) {
  (void)self, (void)r;
  return a->error(a->context, "takes no model"), BF_FAILED;
}
static int32_t cart_facts(void* self, bf_base_facts* f, const bf_answer* a) {
  (void)a;
  f->flags = BF_BASE_STATE_SPACE, f->hold = BF_HOLD_ZERO_ORDER, f->delay_s = *(double*)self;
  return BF_OK;
}
static int32_t cart_lists(void* self, const bf_answer* a) {
  const bf_fit_parameter mass = {sizeof mass, BF_FIT_LOGARITHMIC, "mass", "kg", "", 0.0, INFINITE, 1.0};
  (void)self;
  return a->parameter(a->context, &mass), BF_OK;
}
static int32_t cart_places(void* self, const bf_answer* a) {
  const bf_place rail = {sizeof rail, 0, "rail", "bearing", "m/s", "m", "N", 0.0, 1.0, 1.0, 1.0};
  (void)self;
  return a->place(a->context, &rail), BF_OK;
}
static int32_t cart_nothing(void* self, const bf_answer* a) { return (void)self, (void)a, BF_OK; }
static int32_t cart_inputs(void* self, const bf_answer* a) { return (void)self, a->input(a->context, 0, 0), BF_OK; }
static int32_t cart_unit(void* self, const bf_answer* a) { return (void)self, a->text(a->context, "m/s/N"), BF_OK; }
static int32_t cart_starts(void* self, const bf_measured_response* const* m, uint32_t count, const bf_answer* a) {
  (void)self;
  if (count == 0 || m[count - 1]->frequency_hz.count == 0) return a->error(a->context, "no response"), BF_FAILED;
  return a->values(a->context, m[count - 1]->frequency_hz.values, 1), BF_OK;
}
static int32_t cart_state_space(void* self, const double* v, const double* known, bf_linear_plant* plant) {
  (void)self, (void)known;
  if (plant->resize(plant, 1, 1, 1) != BF_OK) return 0;
  plant->B[0] = 1.0 / v[0], plant->E[0] = -1.0 / v[0], plant->Cf[0] = 1.0, plant->C[0] = 1.0;
  return 1;
}
static int32_t cart_response(void* self, const double* v, const double* known, double re, double im, double* m) {
  (void)self, (void)v, (void)known, (void)re, (void)im, (void)m;
  return 0;
}
static void cart_react(void* self, const double* v, const double* k, uint64_t place, const bf_signals* s, bf_reaction* r) {
  (void)self, (void)v, (void)k, (void)place, (void)s, *r = (bf_reaction){0.0, 0.0, 0.0};
}
static int32_t cart_create(const bf_factory* factory, const bf_host* host, void* made) {
  (void)factory;
  const bf_base_model c = {sizeof c,
                           0,
                           calloc(1, sizeof(double)),
                           cart_configure,
                           cart_use,
                           cart_facts,
                           cart_lists,
                           cart_places,
                           cart_nothing,
                           cart_inputs,
                           cart_unit,
                           cart_nothing,
                           cart_starts,
                           cart_state_space,
                           cart_response,
                           cart_react,
                           free};
  if (c.self == NULL) return fail(host, "no memory");
  memcpy(made, &c, sizeof c);
  return BF_OK;
}

/* ---- the plugin ------------------------------------------------------------------------------------------------------ */

static const bf_factory all[] = {{sizeof all[0], 0, "block", "pinned.ramp", &ramp, ramp_create},
                                 {sizeof all[0], 0, "block", "pinned.scale", &scale, scale_create},
                                 {sizeof all[0], 0, "block", "pinned.delay", &delay, delay_create},
                                 {sizeof all[0], 0, "block", "pinned.pair", &pair, pair_create},
                                 {sizeof all[0], 0, "block", "pinned.sum", &sum, sum_create},
                                 {sizeof all[0], 0, "effect", "pinned.drag", &drag, drag_create},
                                 {sizeof all[0], 0, "base_model", "pinned.cart", &cart, cart_create}};
static const bf_factory* const pointers[] = {&all[0], &all[1], &all[2], &all[3], &all[4], &all[5], &all[6]};
static const bf_factory* const* factories(const bf_host* host, uint32_t* count) {
  return (void)host, *count = COUNT(pointers), pointers;
}

__attribute__((section(".note.bodeflow"), used, aligned(4))) static const struct {
  uint32_t name_size, descriptor_size, type;
  char name[12];
  bf_elf_note descriptor;
} note = {9, sizeof(bf_elf_note), BF_NOTE_TYPE, BF_NOTE_NAME, {BF_PLUGIN_MAGIC, 1, 0, "pinned", "1.0.0", "C, 2026"}};

EXPORT const bf_plugin bodeflow_plugin_v1 = {BF_PLUGIN_MAGIC, 1,       0,         sizeof(bf_plugin), 0,
                                             "pinned",        "1.0.0", "C, 2026", factories};

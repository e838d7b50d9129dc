/* bodeflow plugin ABI 1.0.
 *
 * The border between the engine ("host") and a plugin. Plain C: no exception, C++ object or allocator crosses it.
 * Authors of plugins use <bodeflow/block.hpp>, a header-only C++ layer on this file.
 *
 * Rules that hold everywhere:
 *  - within major version 1 nothing here changes its place or meaning: a plugin that was built against 1.0 loads and gives the
 *    same results in every 1.x;
 *  - a struct that begins with `struct_size` may grow at its end; whoever fills it sets that size, readers ignore what lies
 *    beyond and do without what is not there. A struct that stands in an array never grows: what belongs to its elements later
 *    comes in an array of its own;
 *  - strings are UTF-8, NUL-terminated, and live as long as the object that they were read from;
 *  - functions that can fail return BF_OK or BF_FAILED; before BF_FAILED the plugin calls host->error with the reason;
 *  - [control] functions are called on one thread, never at the same time as any other function of the same block;
 *    [process] functions are called by one thread at a time, possibly another one than [control].
 */
#ifndef BODEFLOW_ABI_H
#define BODEFLOW_ABI_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define BF_ABI_MAJOR 1
#define BF_ABI_MINOR 0
/* "BODEFLOW" read as a little-endian integer. */
#define BF_PLUGIN_MAGIC UINT64_C(0x574F4C4645444F42)
/* The one exported data symbol of a plugin, of type bf_plugin. */
#define BF_PLUGIN_SYMBOL "bodeflow_plugin_v1"
/* Name and type of the ELF note that the SDK writes; its descriptor is one bf_elf_note. */
#define BF_NOTE_NAME "bodeflow"
#define BF_NOTE_TYPE 1

enum { BF_OK = 0, BF_FAILED = 1 };

/* ---- values --------------------------------------------------------------------------------------------------- */

/* Element types. Streams carry f64 or c64 (complex double, re then im); arrays of records any of these. */
enum { BF_ANY = 0, BF_F64 = 1, BF_C64 = 2, BF_I64 = 3, BF_U8 = 4 };

/* A sample rate as an exact fraction in hertz; num = 0 means unknown. */
typedef struct bf_rate {
  int64_t num;
  int64_t den;
} bf_rate;

/* Types of parameters. */
enum {
  BF_BOOL = 1,          /* integer: 0 or 1 */
  BF_INTEGER = 2,       /* integer */
  BF_NUMBER = 3,        /* numbers[0], in the parameter's unit */
  BF_STRING = 4,        /* strings[0] */
  BF_CHOICE = 5,        /* strings[0], one of the choices */
  BF_FILE = 6,          /* strings[0], an absolute path: the host resolves it against the graph file */
  BF_NUMBERS = 7,       /* numbers[0 .. rows), in the parameter's unit */
  BF_INTEGERS = 8,      /* integers[0 .. rows) */
  BF_STRINGS = 9,       /* strings[0 .. rows) */
  BF_COMPLEX_LIST = 10, /* numbers[0 .. 2 rows): re, im, re, im ... */
  BF_MATRIX = 11        /* numbers[0 .. rows * columns), row-major */
};

typedef struct bf_parameter_value {
  uint32_t struct_size;
  uint32_t type;
  uint32_t given; /* 1: written in the graph, 0: the default (or absent, then rows = 0) */
  uint32_t rows;  /* entries; 1 for a scalar that has a value, 0 where there is none */
  uint32_t columns;
  int64_t integer;
  const double* numbers;
  const int64_t* integers;
  const char* const* strings;
} bf_parameter_value;

/* ---- descriptions (static, read before any block is made) ------------------------------------------------------ */

enum { BF_STREAM = 1, BF_MESSAGE = 2 };
enum { BF_IN = 1, BF_OUT = 2 };
enum { BF_PORT_OPTIONAL = 1 /* an input that may stay unconnected */ };

typedef struct bf_port_descriptor {
  uint32_t struct_size;
  uint32_t kind;      /* BF_STREAM or BF_MESSAGE */
  uint32_t direction; /* BF_IN or BF_OUT */
  uint32_t flags;
  uint32_t element; /* streams: BF_F64, BF_C64, BF_ANY */
  const char* name;
  const char* record_type; /* messages: the type carried, or NULL for any */
  const char* doc;
} bf_port_descriptor;

enum {
  BF_PARAMETER_REQUIRED = 1,
  BF_PARAMETER_LIVE = 2,          /* may change while running, through bf_block.change */
  BF_PARAMETER_EXCLUSIVE_MIN = 4, /* the range does not include its minimum */
  BF_PARAMETER_EXCLUSIVE_MAX = 8
};

typedef struct bf_parameter_descriptor {
  uint32_t struct_size;
  uint32_t type;
  uint32_t flags;
  uint32_t choice_count;
  const char* name; /* a dot groups: `lines.first` is written `lines: {first: ...}` */
  const char* unit; /* of BF_NUMBER and BF_NUMBERS: "Hz", "s", "V", "1" (dimensionless), "" (any) */
  const char* doc;
  const char* const* choices;
  const char* aliases;         /* earlier names, separated by spaces, or NULL */
  double minimum;              /* -inf where free */
  double maximum;              /* +inf where free */
  bf_parameter_value fallback; /* the default; rows = 0: none */
} bf_parameter_descriptor;

enum {
  BF_BLOCK_REALTIME_SAFE = 1, /* process neither allocates, locks nor does I/O */
  BF_BLOCK_IN_PLACE = 2,      /* output k may share memory with input k of equal element and channels */
  BF_BLOCK_ASYNCHRONOUS = 4   /* message ports only: may compute on another thread during its latency */
};

typedef struct bf_block_descriptor {
  uint32_t struct_size;
  uint32_t flags;
  uint32_t port_count;
  uint32_t parameter_count;
  const char* id;         /* "family.name" */
  const char* summary;    /* one sentence */
  const char* doc;        /* the rest, may be empty */
  const char* references; /* author, title, year, DOI; one a line; may be empty */
  const char* roles;      /* words separated by spaces, e.g. "source", "identifier"; may be empty */
  double cost_ns;         /* typical cost of one firing in nanoseconds: the planner partitions by it */
  /* Stream inputs, stream outputs, message inputs and message outputs each count from 0. */
  const bf_port_descriptor* const* ports;
  const bf_parameter_descriptor* const* parameters;
} bf_block_descriptor;

/* ---- facts (after configure, before activate) ------------------------------------------------------------------ */

/* Something that is known of a stream beside its facts, for advice before a run: "excitation.period" and the like. */
typedef struct bf_note {
  const char* name;
  const double* values;
  uint64_t count;
} bf_note;

/* What is true of a stream. `known` = 0: nothing yet (inside a loop the facts arrive in several passes). */
typedef struct bf_stream_facts {
  uint32_t struct_size;
  uint32_t known;
  uint32_t element;
  uint32_t channels;
  bf_rate rate;
  int64_t length;                   /* samples until the end of the stream; -1: it has no end of its own */
  const char* unit;                 /* "" where unknown or where channels differ */
  const char* clock;                /* clock domain; "" is the engine's own */
  const char* const* channel_names; /* NULL or `channels` names */
  const char* const* channel_units; /* NULL or `channels` units */
  const bf_note* notes;
  uint64_t note_count;
} bf_stream_facts;

/* How a stream port moves data. A block fires a whole number of times; a firing takes `samples` of each input and gives
 * `samples` to each output. `delay` (inputs only) is the number of samples that stand on the edge before the first real
 * one: at its firing n the block sees input sample n - delay. A loop needs at least one such edge. */
typedef struct bf_flow {
  uint32_t struct_size;
  uint32_t samples;
  uint64_t delay;
  const double* initial; /* delay x channels values, channel after channel (c64: re, im pairs); NULL: zeros */
} bf_flow;

typedef struct bf_resolution {
  uint32_t struct_size;
  uint32_t input_count;          /* stream inputs */
  uint32_t output_count;         /* stream outputs */
  const bf_stream_facts* inputs; /* from the host; known = 0 too for an unconnected optional input */
  bf_stream_facts* outputs;      /* to be filled; strings stay valid until the next resolve or destroy */
  bf_flow* input_flows;          /* preset to {1, 0, NULL} */
  bf_flow* output_flows;         /* preset to {1, 0, NULL} */
} bf_resolution;

/* ---- records ---------------------------------------------------------------------------------------------------- */

/* A record's bytes: 64-byte aligned, laid out as <bodeflow/record.hpp> tells. The host owns and counts it. */
typedef struct bf_record {
  uint8_t* bytes;
  uint64_t size;
} bf_record;

/* ---- host ------------------------------------------------------------------------------------------------------- */

typedef struct bf_host {
  uint32_t struct_size;
  uint32_t abi_major;
  uint32_t abi_minor;
  uint32_t reserved;
  void* context;
  /* [any thread] States why the call in progress is about to return BF_FAILED. The text is copied. */
  void (*error)(const struct bf_host* host, const char* text);
  /* [any thread] A service by its id ("bodeflow.log/1"), or NULL. */
  const void* (*extension)(const struct bf_host* host, const char* id);
  /* [any thread] A record of `size` bytes, count 1, zeroed; writable until it is emitted. NULL when out of memory. */
  bf_record* (*record_create)(const struct bf_host* host, uint64_t size);
  void (*record_retain)(const struct bf_host* host, const bf_record* record);
  void (*record_release)(const struct bf_host* host, const bf_record* record);
} bf_host;

#define BF_EXTENSION_LOG "bodeflow.log/1"
enum { BF_LOG_DEBUG = 0, BF_LOG_INFO = 1, BF_LOG_WARNING = 2, BF_LOG_ERROR = 3 };
typedef struct bf_log {
  uint32_t struct_size;
  /* [any thread] Prefixed with the block's name by the host. */
  void (*write)(const bf_host* host, int32_t level, const char* text);
} bf_log;

#define BF_EXTENSION_FILES "bodeflow.files/1"
typedef struct bf_files {
  uint32_t struct_size;
  /* [control] Notes an input file, so that its checksum stands in the manifest. */
  int32_t (*note_input)(const bf_host* host, const char* path);
  /* [control] The absolute path of a file that the block may write: inside the run directory. Returns NULL, with the
   * reason in host->error, for an absolute path, one that leaves the directory, or one that another block writes.
   * The string lives as long as the block. During a check there is no run directory: the empty string. */
  const char* (*output_path)(const bf_host* host, const char* name);
} bf_files;

/* ---- running ---------------------------------------------------------------------------------------------------- */

typedef struct bf_activation {
  uint32_t struct_size;
  uint32_t realtime;     /* 1: the clock does not wait */
  uint64_t max_count;    /* most firings in one process call */
  uint64_t seed;         /* of this block: derived from the run's seed and the block's name */
  bf_rate rate;          /* firings per second; num = 0 for a block without streams */
  uint32_t vector_level; /* widest vector unit that kernels may use: x86-64 level 1 (SSE2), 3 (AVX2), 4 (AVX-512) */
  uint32_t reserved;
} bf_activation;

/* One stream port during a process call: channel c begins at channels[c] + offset * element size. */
typedef struct bf_stream {
  void* const* channels;
  uint64_t offset;
  uint64_t count;         /* samples in this call */
  uint32_t channel_count; /* 0: unconnected optional input */
  uint32_t element;
} bf_stream;

typedef struct bf_message {
  uint32_t port; /* index among the block's message inputs */
  uint32_t reserved;
  double time; /* seconds, when the record was made by its producer's clock */
  const bf_record* record;
} bf_message;

typedef struct bf_process {
  uint32_t struct_size;
  uint32_t message_count;     /* records that take effect before the first firing of this call */
  const bf_message* messages; /* in order of effect */
  const bf_stream* inputs;    /* stream inputs */
  const bf_stream* outputs;   /* stream outputs */
  uint64_t position;          /* index of the first firing of this call */
  uint64_t count;             /* firings in this call; 0: only messages, or finish */
  uint64_t done;              /* out, preset to count: a source that ends sets the firings that it made */
  void* context;              /* the host's */
  /* [process] Sends a record, `offset` firings after `position` (0..count). Ownership of one count goes to the host. */
  void (*emit)(struct bf_process* process, uint32_t port, bf_record* record, uint64_t offset);
} bf_process;

/* One block. Life: create, configure, resolve (any number of times), activate, process/change ..., finish,
 * reset (back to the state after activate) or deactivate, destroy. */
typedef struct bf_block {
  uint32_t struct_size;
  uint32_t reserved;
  void* self;
  /* [control] One value per described parameter, in that order; checked against the description by the host. */
  int32_t (*configure)(void* self, const bf_parameter_value* values, uint32_t count);
  /* [control] Pure: same inputs, same outputs. */
  int32_t (*resolve)(void* self, bf_resolution* resolution);
  /* [control] Everything that process needs is allocated and opened here. */
  int32_t (*activate)(void* self, const bf_activation* activation);
  /* [process] */
  int32_t (*process)(void* self, bf_process* process);
  /* [process] A live parameter takes a new value, between samples. */
  int32_t (*change)(void* self, uint32_t parameter, const bf_parameter_value* value);
  /* [process] End of all streams: last records may be emitted. Not called after an error. */
  int32_t (*finish)(void* self, bf_process* process);
  /* [control] */
  int32_t (*reset)(void* self);
  /* [control] Files closed, memory given back. */
  void (*deactivate)(void* self);
  /* [control] */
  void (*destroy)(void* self);
  /* [control] An optional ability by its id, or NULL. */
  const void* (*extension)(void* self, const char* id);
} bf_block;

/* An extension of a block: what a graph's author should know before it runs. */
#define BF_EXTENSION_ADVICE "bodeflow.advice/1"
typedef struct bf_advice {
  uint32_t struct_size;
  /* [control] After the last resolve, whose facts `resolution` has (final, of inputs and outputs): calls `tell` with
   * BF_LOG_INFO or BF_LOG_WARNING once for each thing to say; the text is copied. */
  int32_t (*advise)(void* self, const bf_resolution* resolution, void* context,
                    void (*tell)(void* context, int32_t level, const char* text));
} bf_advice;

/* ---- parts: effects and base models ----------------------------------------------------------------------------- */

/* What a tracer fits: a base model is a plant with parameters, an effect is something physical that a plant may lack. Both
 * are made once and never change afterwards (a base model: once it is configured), so their functions are pure and may be
 * called by several threads at the same time. `p` and `v` are the values of the parameters in their order. A function
 * without a result that fails gives NaN instead, and tells the reason once through the host's log. */

typedef struct bf_numbers {
  const double* values; /* complex ones as re, im pairs */
  uint64_t count;       /* of doubles */
} bf_numbers;

enum {
  BF_FIT_LOGARITHMIC = 1, /* positive by nature, fitted as its logarithm */
  BF_FIT_EACH_RECORD = 2  /* has a value of its own in every record */
};

typedef struct bf_fit_parameter {
  uint32_t struct_size;
  uint32_t flags;
  const char* name;
  const char* unit;
  const char* doc;
  double low; /* what physics allows: -inf, +inf where free */
  double high;
  double scale; /* a typical size of what is not fitted as a logarithm */
} bf_fit_parameter;

/* A spot of a plant where something may be missing. */
typedef struct bf_place {
  uint32_t struct_size;
  uint32_t reserved;
  const char* name; /* "" of the empty place */
  const char* kind;
  const char* flow_unit;
  const char* stored_unit;
  const char* reaction_unit;
  double coefficient; /* linear one of the base model there */
  double flow;        /* largest magnitudes on the records */
  double stored;
  double effort;
} bf_place;

/* What a law sees at its place, at the end of a step of the simulation. */
typedef struct bf_signals {
  double flow;
  double stored;
  double time_s; /* since the record began */
  double step_s;
  double gain; /* by how much a unit of reaction lowers the flow within the step */
} bf_signals;

typedef struct bf_reaction {
  double value;
  double by_flow; /* slopes */
  double by_stored;
} bf_reaction;

/* Takes what a function of a part gives. Valid during the call; called on its thread; what is handed over is copied. */
typedef struct bf_answer {
  uint32_t struct_size;
  uint32_t reserved;
  void* context;
  /* Before BF_FAILED: the reason. */
  void (*error)(void* context, const char* text);
  void (*text)(void* context, const char* text);
  void (*values)(void* context, const double* values, uint64_t count);
  void (*parameter)(void* context, const bf_fit_parameter* parameter);
  void (*place)(void* context, const bf_place* place);
  void (*input)(void* context, int32_t channel, int32_t derivative);
} bf_answer;

/* How an effect acts. */
enum {
  BF_ACTS_LAW = 1,        /* at a place, `react`: a reaction over flow and stored quantity */
  BF_ACTS_IMMITTANCE = 2, /* at a place, `transfer`: effort lost = Z(s) flow */
  BF_ACTS_INPUT = 3,      /* `map`: on the samples of the input */
  BF_ACTS_OUTPUT = 4,     /* `map`: on the samples of the output */
  BF_ACTS_SERIES = 5,     /* `transfer`: multiplies the response */
  BF_ACTS_PARALLEL = 6,   /* `transfer`: added to the response from the first input */
  BF_ACTS_DELAY = 7,      /* `delay_s`: the output comes later */
  BF_ACTS_TONE = 8        /* `tones_hz`: sinusoids that the input does not make */
};
enum {
  BF_EFFECT_ROUGH = 1,            /* the law jumps or has corners */
  BF_EFFECT_NONSTATIONARY = 2,    /* depends on the time since the record began */
  BF_EFFECT_MEMORYLESS_LINEAR = 4 /* the map adds a constant */
};

/* Descriptor of the kind "effect". */
typedef struct bf_effect_descriptor {
  uint32_t struct_size;
  uint32_t flags;
  uint32_t acts;
  uint32_t steps_per_sample; /* of the simulation, at least 1 */
  uint64_t memory;           /* numbers that a law or a map keeps from step to step */
  uint32_t kind_count;
  uint32_t equivalent_count;
  const char* id; /* "family.name" */
  const char* summary;
  const char* doc;
  const char* references;
  const char* separation;         /* what would tell the equivalents apart */
  const char* const* kinds;       /* of places, for laws and immittances */
  const char* const* equivalents; /* names of effects that no experiment of this kind tells apart */
} bf_effect_descriptor;

/* What is known before an effect is fitted; see <bodeflow/effect.hpp>. */
typedef struct bf_situation {
  uint32_t struct_size;
  uint32_t reserved;
  const char* input_unit;
  const char* output_unit;
  double sample_time_s;
  double duration_s;
  double input_peak;
  double input_rms;
  double output_peak;
  double output_rms;
  double residual_mean;
  double residual_rms;
  const bf_place* place;
  bf_numbers line_hz;
  bf_numbers response; /* complex */
  bf_numbers missing;  /* complex */
  bf_numbers missing_std;
  bf_numbers peaks_hz;
  bf_numbers jumps_s;
} bf_situation;

/* What the factory of an effect makes. All functions are there; those that do not belong to the way it acts are not called. */
typedef struct bf_effect {
  uint32_t struct_size;
  uint32_t reserved;
  void* self;
  /* answer->text: why it can't act there, not called if it can. */
  int32_t (*refuses)(void* self, const bf_situation* situation, const bf_answer* answer);
  /* answer->parameter for each. */
  int32_t (*parameters)(void* self, const bf_situation* situation, const bf_answer* answer);
  /* answer->values for each start. */
  int32_t (*starts)(void* self, const bf_situation* situation, const bf_answer* answer);
  /* answer->text: the effect with its values, as a part of a sentence. */
  int32_t (*sentence)(void* self, const bf_numbers* value, const bf_numbers* std, const bf_situation* situation,
                      const bf_answer* answer);
  /* `memory` is what stood in `next` after the step before; several calls a step with trial values. */
  void (*react)(void* self, const double* p, const bf_signals* signals, const double* memory, double* next,
                bf_reaction* reaction);
  /* The sample that takes the place of x, once a sample in their order. */
  double (*map)(void* self, const double* p, double x, double time_s, double* memory);
  /* At s = re + j im; writes re, im. */
  void (*transfer)(void* self, const double* p, double re, double im, double* result);
  double (*delay_s)(void* self, const double* p);
  /* answer->values once. */
  int32_t (*tones_hz)(void* self, const double* p, const bf_answer* answer);
  void (*destroy)(void* self);
} bf_effect;

enum { BF_HOLD_ZERO_ORDER = 1, BF_HOLD_FIRST_ORDER = 2, BF_HOLD_BAND_LIMITED = 3 };
enum {
  BF_BASE_STATE_SPACE = 1, /* `state_space` fills the plant; otherwise only `response` */
  BF_BASE_LAWS = 2         /* has laws of its own, `react` */
};

/* What a configured base model is beside its lists. */
typedef struct bf_base_facts {
  uint32_t struct_size;
  uint32_t flags;
  uint32_t hold;
  uint32_t reserved;
  double delay_s;
  double filter_hz;
} bf_base_facts;

/* A linear plant; the matrices are row-major, see <bodeflow/plant.hpp>. */
typedef struct bf_linear_plant {
  uint32_t struct_size;
  int32_t states;
  int32_t inputs;
  int32_t places;
  /* The first call of whoever fills it: sets the sizes, and the matrices to zeros. BF_FAILED: no memory. */
  int32_t (*resize)(struct bf_linear_plant* plant, int32_t states, int32_t inputs, int32_t places);
  void* context;
  double *A, *B, *E, *Cf, *Df, *Ff, *Cs, *Ds, *Fs, *C, *D, *F;
} bf_linear_plant;

/* A measured response between an input and the output. */
typedef struct bf_measured_response {
  uint32_t struct_size;
  uint32_t reserved;
  bf_numbers frequency_hz;
  bf_numbers response; /* complex */
  bf_numbers weight;
  bf_numbers known;
} bf_measured_response;

/* What the factory of a base model makes; the descriptor of the kind "base_model" is a bf_block_descriptor without ports.
 * Life: create, configure, use_model where there is one, then all others. */
typedef struct bf_base_model {
  uint32_t struct_size;
  uint32_t reserved;
  void* self;
  /* One value per described parameter, in that order; checked against the description by the caller. */
  int32_t (*configure)(void* self, const bf_parameter_value* values, uint32_t count, const bf_answer* answer);
  /* A record of a model, for a black box. */
  int32_t (*use_model)(void* self, const bf_record* record, const bf_answer* answer);
  int32_t (*facts)(void* self, bf_base_facts* facts, const bf_answer* answer);
  int32_t (*parameters)(void* self, const bf_answer* answer); /* answer->parameter for each */
  int32_t (*places)(void* self, const bf_answer* answer);     /* answer->place for each */
  int32_t (*known)(void* self, const bf_answer* answer);      /* answer->parameter for each */
  int32_t (*inputs)(void* self, const bf_answer* answer);     /* answer->input for each */
  /* answer->text once: of the output over the first input, "" for any. */
  int32_t (*response_unit)(void* self, const bf_answer* answer);
  int32_t (*conventions)(void* self, const bf_answer* answer); /* answer->text for each */
  /* answer->values for each start. */
  int32_t (*starts)(void* self, const bf_measured_response* const* measured, uint32_t count, const bf_answer* answer);
  /* 1: filled; 0: outside of the domain of the parameters. */
  int32_t (*state_space)(void* self, const double* v, const double* known, bf_linear_plant* plant);
  /* At s = re + j im: (1 + places) x (inputs + places) complex numbers. 1: filled; 0: outside of the domain. */
  int32_t (*response)(void* self, const double* v, const double* known, double re, double im, double* matrix);
  void (*react)(void* self, const double* v, const double* known, uint64_t place, const bf_signals* signals,
                bf_reaction* reaction);
  void (*destroy)(void* self);
} bf_base_model;

/* A service of the host: the parts of all plugins. */
#define BF_EXTENSION_PARTS "bodeflow.parts/1"
typedef struct bf_parts {
  uint32_t struct_size;
  /* [any thread] The descriptors of that kind ("effect": const bf_effect_descriptor*, "base_model": const
   * bf_block_descriptor*), ordered by id. They live as long as the block. */
  const void* const* (*list)(const bf_host* host, const char* kind, uint32_t* count);
  /* [any thread] Fills `made` (bf_effect*, bf_base_model*) with a new part, which is destroyed before the block is. */
  int32_t (*create)(const bf_host* host, const char* kind, const char* id, void* made);
} bf_parts;

/* ---- plugin ----------------------------------------------------------------------------------------------------- */

/* Something that a plugin can make. Kinds that the host does not know are ignored. */
typedef struct bf_factory {
  uint32_t struct_size;
  uint32_t reserved;
  const char* kind; /* "block", "effect", "base_model" */
  const char* id;
  const void* descriptor; /* const bf_block_descriptor*; of an effect const bf_effect_descriptor* */
  /* Fills `made` (bf_block*, bf_effect*, bf_base_model*). `host` outlives what is made. [control] for blocks, [any thread]
   * for the others. */
  int32_t (*create)(const struct bf_factory* factory, const bf_host* host, void* made);
} bf_factory;

typedef struct bf_plugin {
  uint64_t magic;
  uint32_t abi_major;
  uint32_t abi_minor;
  uint32_t struct_size;
  uint32_t reserved;
  const char* name;
  const char* version;
  const char* build; /* compiler and library, for messages */
  /* [control] The factories, made at the first call; NULL on failure, with the reason in host->error. */
  const bf_factory* const* (*factories)(const bf_host* host, uint32_t* count);
} bf_plugin;

/* Descriptor of the ELF note, read as bytes before any code of the file runs. */
typedef struct bf_elf_note {
  uint64_t magic;
  uint32_t abi_major;
  uint32_t abi_minor;
  char name[48];
  char version[16];
  char build[64];
} bf_elf_note;

#ifdef __cplusplus
}
#endif

#endif

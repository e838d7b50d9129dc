/* A linear system as a co-simulation unit of FMI 2.0: dx/dt = A x + B u (or x[n+1] = A x[n] + B u[n]), y = C x + D u.

   The matrices stand in resources/system.txt: a line "bodeflow-linear-system 1", a line with sample time (0: continuous), states,
   inputs and outputs, then the rows of A, B, C, D. Value references: 0 .. inputs - 1 are inputs, then come the outputs.

   Inputs are held over a communication step. A continuous system is advanced by exp([A B; 0 0] h) (scaling and squaring with a
   Pade approximant), kept for the next step of the same length; a discrete one by the samples that the step reaches. */

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define FMI __attribute__((visibility("default")))

typedef void* fmi2Component;
typedef void* fmi2FMUstate;
typedef unsigned int fmi2ValueReference;
typedef double fmi2Real;
typedef int fmi2Integer;
typedef int fmi2Boolean;
typedef const char* fmi2String;
typedef char fmi2Byte;
typedef enum { fmi2OK, fmi2Warning, fmi2Discard, fmi2Error, fmi2Fatal, fmi2Pending } fmi2Status;
typedef enum { fmi2ModelExchange, fmi2CoSimulation } fmi2Type;
typedef void (*fmi2CallbackLogger)(void*, fmi2String, fmi2Status, fmi2String, fmi2String, ...);
typedef struct {
  fmi2CallbackLogger logger;
  void* (*allocateMemory)(size_t, size_t);
  void (*freeMemory)(void*);
  void (*stepFinished)(void*, fmi2Status);
  void* environment;
} fmi2CallbackFunctions;

typedef struct {
  int n, m, p;
  double sample_time;
  double *A, *B, *C, *D; /* rows one after the other */
  double *x, *u, *next;
  double time;
  long long sample; /* how many samples x has seen */
  double step;      /* length that `phi` belongs to; 0: none */
  double* phi;      /* (n + m) x (n + m): exp([A B; 0 0] step) */
  char* name;
  fmi2CallbackFunctions callbacks;
} System;

typedef struct {
  double time;
  long long sample;
  double values[]; /* x, then u */
} State;

static fmi2Status complain(const System* s, const char* text) {
  if (s != NULL && s->callbacks.logger != NULL)
    s->callbacks.logger(s->callbacks.environment, s->name, fmi2Error, "error", "%s", text);
  return fmi2Error;
}

static double* numbers(size_t count) { return calloc(count > 0 ? count : 1, sizeof(double)); }

static void release(System* s) {
  if (s == NULL) return;
  double* all[] = {s->A, s->B, s->C, s->D, s->x, s->u, s->next, s->phi};
  for (size_t i = 0; i < sizeof all / sizeof *all; ++i) free(all[i]);
  free(s->name);
  free(s);
}

/* ---- reading */

static int hex(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  return c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
}

/* The path of a file URI (file:///a%20b, file:/a, or a plain path) with a file's name behind it. */
static char* path_of(const char* uri, const char* file) {
  const char* at = uri;
  if (strncmp(at, "file:", 5) == 0) {
    at += 5;
    if (strncmp(at, "//", 2) == 0) {
      at += 2;
      while (*at != '\0' && *at != '/') ++at; /* the host */
    }
  }
  char* path = malloc(strlen(at) + strlen(file) + 2);
  if (path == NULL) return NULL;
  char* to = path;
  for (; *at != '\0'; ++at) {
    const int escaped = *at == '%' && hex(at[1]) >= 0 && hex(at[2]) >= 0;
    *to++ = escaped ? (char)(16 * hex(at[1]) + hex(at[2])) : *at;
    if (escaped) at += 2;
  }
  if (to == path || to[-1] != '/') *to++ = '/';
  strcpy(to, file);
  return path;
}

/* A number as it was written, whatever the decimal point of the process's locale is. */
static int read_number(FILE* file, double* value) {
  char text[64], *end;
  if (fscanf(file, "%63s", text) != 1) return 0;
  *value = strtod(text, &end);
  if (*end == '.') {
    *end = ',';
    *value = strtod(text, &end);
  }
  return *end == '\0';
}

static int read_all(FILE* file, double* values, size_t count) {
  for (size_t i = 0; i < count; ++i)
    if (!read_number(file, values + i)) return 0;
  return 1;
}

static int read_system(System* s, FILE* file) {
  int version = 0;
  if (fscanf(file, "bodeflow-linear-system %d", &version) != 1 || version != 1) return 0;
  if (!read_number(file, &s->sample_time) || fscanf(file, "%d %d %d", &s->n, &s->m, &s->p) != 3) return 0;
  if (s->n < 0 || s->m < 1 || s->p < 1 || s->n > 20000 || s->m > 10000 || s->p > 10000 || !(s->sample_time >= 0)) return 0;
  const size_t n = (size_t)s->n, m = (size_t)s->m, p = (size_t)s->p;
  s->A = numbers(n * n);
  s->B = numbers(n * m);
  s->C = numbers(p * n);
  s->D = numbers(p * m);
  s->x = numbers(n);
  s->u = numbers(m);
  s->next = numbers(n);
  s->phi = numbers((n + m) * (n + m));
  if (!s->A || !s->B || !s->C || !s->D || !s->x || !s->u || !s->next || !s->phi) return 0;
  return read_all(file, s->A, n * n) && read_all(file, s->B, n * m) && read_all(file, s->C, p * n) && read_all(file, s->D, p * m);
}

/* ---- the matrix exponential */

static void multiply(size_t n, const double* a, const double* b, double* c) {
  memset(c, 0, n * n * sizeof(double));
  for (size_t i = 0; i < n; ++i)
    for (size_t k = 0; k < n; ++k) {
      const double f = a[i * n + k];
      if (f == 0) continue;
      for (size_t j = 0; j < n; ++j) c[i * n + j] += f * b[k * n + j];
    }
}

/* a := a^-1 b in place of b, by elimination with row exchanges; 0 where a is singular. */
static int solve(size_t n, double* a, double* b) {
  for (size_t k = 0; k < n; ++k) {
    size_t best = k;
    for (size_t i = k + 1; i < n; ++i)
      if (fabs(a[i * n + k]) > fabs(a[best * n + k])) best = i;
    if (a[best * n + k] == 0) return 0;
    for (size_t j = 0; best != k && j < n; ++j) {
      double t = a[k * n + j];
      a[k * n + j] = a[best * n + j];
      a[best * n + j] = t;
      t = b[k * n + j];
      b[k * n + j] = b[best * n + j];
      b[best * n + j] = t;
    }
    for (size_t i = k + 1; i < n; ++i) {
      const double f = a[i * n + k] / a[k * n + k];
      if (f == 0) continue;
      for (size_t j = k; j < n; ++j) a[i * n + j] -= f * a[k * n + j];
      for (size_t j = 0; j < n; ++j) b[i * n + j] -= f * b[k * n + j];
    }
  }
  for (size_t k = n; k-- > 0;)
    for (size_t j = 0; j < n; ++j) {
      double sum = b[k * n + j];
      for (size_t i = k + 1; i < n; ++i) sum -= a[k * n + i] * b[i * n + j];
      b[k * n + j] = sum / a[k * n + k];
    }
  return 1;
}

/* e := exp(a), n x n: Pade approximant of degree 8 of a scaled to a norm below 1/2, squared back. Its error is below 1e-19. */
static int exponential(size_t n, double* a, double* e) {
  enum { kDegree = 8 };
  double norm = 0;
  for (size_t i = 0; i < n; ++i) {
    double sum = 0;
    for (size_t j = 0; j < n; ++j) sum += fabs(a[i * n + j]);
    if (sum > norm) norm = sum;
  }
  if (!isfinite(norm)) return 0;
  int squarings = 0;
  while (norm > 0.5) {
    norm /= 2;
    ++squarings;
  }
  for (size_t i = 0; i < n * n; ++i) a[i] = ldexp(a[i], -squarings);
  double *power = numbers(n * n), *product = numbers(n * n), *below = numbers(n * n);
  const int fine = power != NULL && product != NULL && below != NULL;
  if (fine) {
    memset(e, 0, n * n * sizeof(double));
    for (size_t i = 0; i < n; ++i) power[i * n + i] = e[i * n + i] = below[i * n + i] = 1;
    double c = 1, sign = 1;
    for (int k = 1; k <= kDegree; ++k) {
      c *= (double)(kDegree - k + 1) / (double)(k * (2 * kDegree - k + 1));
      sign = -sign;
      multiply(n, a, power, product);
      memcpy(power, product, n * n * sizeof(double));
      for (size_t i = 0; i < n * n; ++i) {
        e[i] += c * power[i];
        below[i] += sign * c * power[i];
      }
    }
  }
  int good = fine && solve(n, below, e);
  for (int k = 0; good && k < squarings; ++k) {
    multiply(n, e, e, product);
    memcpy(e, product, n * n * sizeof(double));
  }
  free(power);
  free(product);
  free(below);
  for (size_t i = 0; good && i < n * n; ++i) good = isfinite(e[i]);
  return good;
}

/* ---- steps */

static int prepare(System* s, double h) {
  if (h == s->step) return 1;
  const size_t n = (size_t)s->n, m = (size_t)s->m, all = n + m;
  double* a = numbers(all * all);
  if (a == NULL) return 0;
  /* B enters linearly: scaled to A's size it does not add to the norm that sets the squarings. */
  double largest_a = 0, largest_b = 0;
  for (size_t i = 0; i < n * n; ++i) largest_a = fmax(largest_a, fabs(s->A[i]));
  for (size_t i = 0; i < n * m; ++i) largest_b = fmax(largest_b, fabs(s->B[i]));
  const int scale = largest_a > 0 && largest_b > 0 ? ilogb(largest_a) - ilogb(largest_b) : 0;
  for (size_t i = 0; i < n; ++i) {
    for (size_t j = 0; j < n; ++j) a[i * all + j] = s->A[i * n + j] * h;
    for (size_t j = 0; j < m; ++j) a[i * all + n + j] = ldexp(s->B[i * m + j], scale) * h;
  }
  const int good = exponential(all, a, s->phi);
  for (size_t i = 0; i < n; ++i)
    for (size_t j = 0; j < m; ++j) s->phi[i * all + n + j] = ldexp(s->phi[i * all + n + j], -scale);
  free(a);
  s->step = good ? h : 0;
  return good;
}

/* x := F x + G u, with rows of F `stride` apart. */
static void advance(System* s, const double* F, const double* G, size_t stride_f, size_t stride_g) {
  const size_t n = (size_t)s->n, m = (size_t)s->m;
  for (size_t i = 0; i < n; ++i) {
    double sum = 0;
    for (size_t j = 0; j < n; ++j) sum += F[i * stride_f + j] * s->x[j];
    for (size_t j = 0; j < m; ++j) sum += G[i * stride_g + j] * s->u[j];
    s->next[i] = sum;
  }
  memcpy(s->x, s->next, n * sizeof(double));
}

static double output(const System* s, size_t i) {
  const size_t n = (size_t)s->n, m = (size_t)s->m;
  double sum = 0;
  for (size_t j = 0; j < n; ++j) sum += s->C[i * n + j] * s->x[j];
  for (size_t j = 0; j < m; ++j) sum += s->D[i * m + j] * s->u[j];
  return sum;
}

static void start(System* s, double time) {
  memset(s->x, 0, (size_t)s->n * sizeof(double));
  memset(s->u, 0, (size_t)s->m * sizeof(double));
  s->time = time;
  s->sample = 0;
}

/* ---- FMI 2.0 */

FMI const char* fmi2GetTypesPlatform(void) { return "default"; }
FMI const char* fmi2GetVersion(void) { return "2.0"; }

FMI fmi2Component fmi2Instantiate(fmi2String name, fmi2Type type, fmi2String guid, fmi2String resources,
                                  const fmi2CallbackFunctions* callbacks, fmi2Boolean visible, fmi2Boolean logging) {
  (void)guid;
  (void)visible;
  (void)logging;
  System* s = calloc(1, sizeof *s);
  if (s == NULL) return NULL;
  if (callbacks != NULL) s->callbacks = *callbacks;
  s->name = malloc(name != NULL ? strlen(name) + 1 : 1);
  if (s->name != NULL) strcpy(s->name, name != NULL ? name : "");
  char* path = resources != NULL && s->name != NULL ? path_of(resources, "system.txt") : NULL;
  FILE* file = path != NULL ? fopen(path, "r") : NULL;
  free(path);
  const int good = type == fmi2CoSimulation && file != NULL && read_system(s, file);
  if (file != NULL) fclose(file);
  if (good) return s;
  complain(s, type == fmi2CoSimulation ? "resources/system.txt can't be read" : "this unit is for co-simulation");
  release(s);
  return NULL;
}

FMI void fmi2FreeInstance(fmi2Component c) { release(c); }

FMI fmi2Status fmi2SetDebugLogging(fmi2Component c, fmi2Boolean on, size_t count, const fmi2String categories[]) {
  (void)c;
  (void)on;
  (void)count;
  (void)categories;
  return fmi2OK;
}

FMI fmi2Status fmi2SetupExperiment(fmi2Component c, fmi2Boolean tolerance_defined, fmi2Real tolerance, fmi2Real start_time,
                                   fmi2Boolean stop_defined, fmi2Real stop_time) {
  (void)tolerance_defined;
  (void)tolerance;
  (void)stop_defined;
  (void)stop_time;
  ((System*)c)->time = start_time;
  return fmi2OK;
}

FMI fmi2Status fmi2EnterInitializationMode(fmi2Component c) { return c != NULL ? fmi2OK : fmi2Error; }
FMI fmi2Status fmi2ExitInitializationMode(fmi2Component c) { return c != NULL ? fmi2OK : fmi2Error; }
FMI fmi2Status fmi2Terminate(fmi2Component c) { return c != NULL ? fmi2OK : fmi2Error; }

FMI fmi2Status fmi2Reset(fmi2Component c) {
  start(c, 0);
  return fmi2OK;
}

FMI fmi2Status fmi2GetReal(fmi2Component c, const fmi2ValueReference references[], size_t count, fmi2Real values[]) {
  const System* s = c;
  const size_t m = (size_t)s->m, p = (size_t)s->p;
  for (size_t i = 0; i < count; ++i) {
    if (references[i] >= m + p) return complain(s, "unknown value reference");
    values[i] = references[i] < m ? s->u[references[i]] : output(s, references[i] - m);
  }
  return fmi2OK;
}

FMI fmi2Status fmi2SetReal(fmi2Component c, const fmi2ValueReference references[], size_t count, const fmi2Real values[]) {
  System* s = c;
  for (size_t i = 0; i < count; ++i) {
    if (references[i] >= (size_t)s->m) return complain(s, "only inputs can be set");
    if (!isfinite(values[i])) return complain(s, "an input is not a finite number");
    s->u[references[i]] = values[i];
  }
  return fmi2OK;
}

FMI fmi2Status fmi2DoStep(fmi2Component c, fmi2Real time, fmi2Real h, fmi2Boolean no_set_state) {
  (void)no_set_state;
  System* s = c;
  const size_t n = (size_t)s->n, m = (size_t)s->m;
  if (!(h >= 0) || !isfinite(h)) return complain(s, "a step must not be negative");
  if (s->sample_time > 0) {
    /* Communication points that fall on a sample up to rounding count as on it. */
    const double reached = floor((time + h) / s->sample_time + 1e-6);
    if (s->sample == 0) s->sample = (long long)floor(time / s->sample_time + 1e-6);
    for (; (double)s->sample < reached; ++s->sample) advance(s, s->A, s->B, n, m);
  } else if (h > 0) {
    if (!prepare(s, h)) return complain(s, "the system grows beyond the range of a double within a step");
    advance(s, s->phi, s->phi + n, n + m, n + m);
  }
  s->time = time + h;
  return fmi2OK;
}

FMI fmi2Status fmi2GetFMUstate(fmi2Component c, fmi2FMUstate* kept) {
  const System* s = c;
  const size_t n = (size_t)s->n, m = (size_t)s->m;
  State* state = *kept != NULL ? *kept : malloc(sizeof *state + (n + m) * sizeof(double));
  if (state == NULL) return complain(s, "no memory for a state");
  state->time = s->time;
  state->sample = s->sample;
  memcpy(state->values, s->x, n * sizeof(double));
  memcpy(state->values + n, s->u, m * sizeof(double));
  *kept = state;
  return fmi2OK;
}

FMI fmi2Status fmi2SetFMUstate(fmi2Component c, fmi2FMUstate kept) {
  System* s = c;
  const State* state = kept;
  if (state == NULL) return complain(s, "no state to set");
  s->time = state->time;
  s->sample = state->sample;
  memcpy(s->x, state->values, (size_t)s->n * sizeof(double));
  memcpy(s->u, state->values + s->n, (size_t)s->m * sizeof(double));
  return fmi2OK;
}

FMI fmi2Status fmi2FreeFMUstate(fmi2Component c, fmi2FMUstate* kept) {
  (void)c;
  free(*kept);
  *kept = NULL;
  return fmi2OK;
}

FMI fmi2Status fmi2SerializedFMUstateSize(fmi2Component c, fmi2FMUstate kept, size_t* size) {
  (void)kept;
  (void)size;
  return complain(c, "states are not serialised");
}
FMI fmi2Status fmi2SerializeFMUstate(fmi2Component c, fmi2FMUstate kept, fmi2Byte bytes[], size_t size) {
  (void)kept;
  (void)bytes;
  (void)size;
  return complain(c, "states are not serialised");
}
FMI fmi2Status fmi2DeSerializeFMUstate(fmi2Component c, const fmi2Byte bytes[], size_t size, fmi2FMUstate* kept) {
  (void)bytes;
  (void)size;
  (void)kept;
  return complain(c, "states are not serialised");
}

FMI fmi2Status fmi2GetDirectionalDerivative(fmi2Component c, const fmi2ValueReference unknown[], size_t unknowns,
                                            const fmi2ValueReference known[], size_t knowns, const fmi2Real change[],
                                            fmi2Real result[]) {
  (void)unknown;
  (void)unknowns;
  (void)known;
  (void)knowns;
  (void)change;
  (void)result;
  return complain(c, "directional derivatives are not given");
}

/* There are no variables of other types, no derivatives of inputs and no asynchronous steps. */
#define NONE_OF(type, Type)                                                                                        \
  FMI fmi2Status fmi2Get##Type(fmi2Component c, const fmi2ValueReference r[], size_t count, type values[]) {       \
    (void)r;                                                                                                       \
    (void)values;                                                                                                  \
    return count == 0 ? fmi2OK : complain(c, "unknown value reference");                                           \
  }                                                                                                                \
  FMI fmi2Status fmi2Set##Type(fmi2Component c, const fmi2ValueReference r[], size_t count, const type values[]) { \
    (void)r;                                                                                                       \
    (void)values;                                                                                                  \
    return count == 0 ? fmi2OK : complain(c, "unknown value reference");                                           \
  }
NONE_OF(fmi2Integer, Integer)
NONE_OF(fmi2Boolean, Boolean)
NONE_OF(fmi2String, String)

FMI fmi2Status fmi2SetRealInputDerivatives(fmi2Component c, const fmi2ValueReference r[], size_t count, const fmi2Integer order[],
                                           const fmi2Real values[]) {
  (void)r;
  (void)count;
  (void)order;
  (void)values;
  return complain(c, "inputs are held over a step: they have no derivatives");
}
FMI fmi2Status fmi2GetRealOutputDerivatives(fmi2Component c, const fmi2ValueReference r[], size_t count,
                                            const fmi2Integer order[], fmi2Real values[]) {
  (void)r;
  (void)count;
  (void)order;
  (void)values;
  return complain(c, "derivatives of outputs are not given");
}
FMI fmi2Status fmi2CancelStep(fmi2Component c) { return complain(c, "steps are not asynchronous"); }

#define NO_STATUS(type, Name)                                                    \
  FMI fmi2Status fmi2Get##Name##Status(fmi2Component c, int kind, type* value) { \
    (void)c;                                                                     \
    (void)kind;                                                                  \
    (void)value;                                                                 \
    return fmi2Discard;                                                          \
  }
NO_STATUS(fmi2Status, )
NO_STATUS(fmi2Real, Real)
NO_STATUS(fmi2Integer, Integer)
NO_STATUS(fmi2Boolean, Boolean)
NO_STATUS(fmi2String, String)

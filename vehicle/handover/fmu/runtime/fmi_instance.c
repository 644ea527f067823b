/* See fmi_instance.h. */
#include "fmi_instance.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *const MODE_NAMES[] = {"instantiated", "in initialization mode", "in step mode", "terminated",
                                         "failed"};

int fail(Instance *self, const char *format, ...) {
  va_list values;
  char text[MESSAGE];
  va_start(values, format);
  vsnprintf(text, sizeof text, format, values);
  va_end(values);
  memcpy(self->message, text, sizeof text);
  if (self->log) self->log(self, 1, self->message);
  return 0;
}

static int mode_of(const Instance *self) { return (int)self->state.mode[0]; }

/* Refuse a call in a mode that is not one of the flags. */
static int require(Instance *self, const char *call, int first, int last) {
  int mode = mode_of(self);
  if (mode >= first && mode <= last) return 1;
  if (mode == FAILED) return fail(self, "%s: the instance failed before; reset or free it", call);
  return fail(self, "%s: the instance is %s, but must be %s", call, MODE_NAMES[mode], MODE_NAMES[first]);
}

Instance *new_instance(const char *name, const char *token, const char *resources, char *message) {
  char path[4096];
  if (!resources || !*resources || strlen(resources) + 10 > sizeof path) {
    snprintf(message, MESSAGE, "the folder of the resources is missing or its path is too long");
    return NULL;
  }
  size_t length = strlen(resources);
  int slash = resources[length - 1] == '/' || resources[length - 1] == '\\';
  snprintf(path, sizeof path, "%s%scar.bin", resources, slash ? "" : "/");
  Car *car = read_car(path, message);
  if (!car) return NULL;
  if (!token || strcmp(token, car->token)) {
    snprintf(message, MESSAGE, "the token of the call is %.60s, that of the resources %s; model description and "
             "resources are of different cars", token ? token : "missing", car->token);
    free_car(car);
    return NULL;
  }
  Instance *self = calloc(1, sizeof(Instance));
  if (!self || !make_state(&self->state, car)) {
    snprintf(message, MESSAGE, "no memory for an instance");
    free(self);
    free_car(car);
    return NULL;
  }
  snprintf(self->name, sizeof self->name, "%s", name ? name : "");
  return self;
}

void free_instance(Instance *self) {
  if (!self) return;
  free_state(&self->state);
  free_car(self->state.car);
  free(self);
}

int begin_initialization(Instance *self, double start_time) {
  if (!require(self, "enter initialization mode", INSTANTIATED, INSTANTIATED)) return 0;
  if (!isfinite(start_time)) return fail(self, "start time: found %g, must be finite", start_time);
  self->state.time[0] = self->state.start_time[0] = self->state.checked[0] = start_time;
  self->state.mode[0] = INITIALIZATION;
  return 1;
}

int end_initialization(Instance *self) {
  if (!require(self, "exit initialization mode", INITIALIZATION, INITIALIZATION)) return 0;
  set_at_rest(&self->state);
  self->state.mode[0] = STEPPING;
  return 1;
}

int terminate_instance(Instance *self) {
  if (!require(self, "terminate", STEPPING, STEPPING)) return 0;
  self->state.mode[0] = TERMINATED;
  return 1;
}

int reset_instance(Instance *self) {
  reset_state(&self->state);
  self->experiment = 0;
  return 1;
}

int get_values(Instance *self, const uint32_t *references, size_t count, double *values) {
  char message[MESSAGE];
  if (count && (!references || !values)) return fail(self, "get values: an array is missing");
  /* Before the first step the outputs follow from the inputs. */
  if (mode_of(self) <= INITIALIZATION) set_at_rest(&self->state);
  for (size_t k = 0; k < count; k++)
    if (!get_value(&self->state, references[k], values + k, message)) return fail(self, "%s", message);
  return 1;
}

int set_values(Instance *self, const uint32_t *references, size_t count, const double *values) {
  char message[MESSAGE];
  if (count && (!references || !values)) return fail(self, "set values: an array is missing");
  if (count && !require(self, "set values", INSTANTIATED, STEPPING)) return 0;
  for (size_t k = 0; k < count; k++)
    if (!set_value(&self->state, references[k], values[k], message)) return fail(self, "%s", message);
  return 1;
}

int advance_instance(Instance *self, double point, double length) {
  char message[MESSAGE];
  Motion *s = &self->state;
  if (!require(self, "do step", STEPPING, STEPPING)) return 0;
  double done = s->steps[0];
  if (!communication_step(s, point, length, message)) {
    /* A refused step does not move the car; a step after which the motion is not finite did. */
    if (s->steps[0] != done) s->mode[0] = FAILED;
    return fail(self, "%s", message);
  }
  for (int64_t k = new_notice(s); k >= 0; k = new_notice(s)) {
    snprintf(self->message, sizeof self->message, "at %g s: %s", s->time[0], notice_of(s->car, k));
    if (self->log) self->log(self, 0, self->message);
  }
  return 1;
}

/* A stored state begins with the token of its car. */
static size_t header(void) { return TOKEN / sizeof(double); }

int copy_state(Instance *self, Stored **stored) {
  size_t size = self->state.size;
  if (!stored) return fail(self, "get state: the pointer is missing");
  if (!*stored) *stored = malloc(sizeof(Stored) + (header() + size) * sizeof(double));
  if (!*stored) return fail(self, "get state: no memory");
  (*stored)->size = header() + size;
  memcpy((*stored)->numbers, self->state.car->token, TOKEN);
  memcpy((*stored)->numbers + header(), self->state.block, size * sizeof(double));
  return 1;
}

static int is_own(const Instance *self, const void *numbers, size_t size) {
  return size == header() + self->state.size && !memcmp(numbers, self->state.car->token, TOKEN);
}

int set_state(Instance *self, const Stored *stored) {
  if (!stored) return fail(self, "set state: the state is missing");
  if (!is_own(self, stored->numbers, stored->size)) return fail(self, "set state: the state is of another car");
  memcpy(self->state.block, stored->numbers + header(), self->state.size * sizeof(double));
  return 1;
}

void free_stored(Stored **stored) {
  if (!stored) return;
  free(*stored);
  *stored = NULL;
}

size_t stored_size(const Instance *self) { return (header() + self->state.size) * sizeof(double); }

int write_state(Instance *self, const Stored *stored, void *bytes, size_t size) {
  if (!stored || !bytes) return fail(self, "serialize state: the state or the buffer is missing");
  if (size < stored_size(self)) return fail(self, "serialize state: found a buffer of %u bytes, must be %u bytes",
                                            (unsigned)size, (unsigned)stored_size(self));
  memcpy(bytes, stored->numbers, stored_size(self));
  return 1;
}

int read_state(Instance *self, const void *bytes, size_t size, Stored **stored) {
  if (!bytes || !stored) return fail(self, "deserialize state: the bytes or the pointer are missing");
  if (size % sizeof(double) || !is_own(self, bytes, size / sizeof(double)))
    return fail(self, "deserialize state: the bytes are no state of this car");
  /* Alignment of the bytes is unknown, so numbers are copied before they are read. */
  const char *first = (const char *)bytes + TOKEN;
  for (size_t k = 0; k < self->state.size; k++) {
    double number;
    memcpy(&number, first + k * sizeof(double), sizeof number);
    if (!isfinite(number)) return fail(self, "deserialize state: the bytes hold numbers that are not finite");
  }
  if (!*stored) *stored = malloc(sizeof(Stored) + size);
  if (!*stored) return fail(self, "deserialize state: no memory");
  (*stored)->size = size / sizeof(double);
  memcpy((*stored)->numbers, bytes, size);
  return 1;
}

/* Instance behind FMI 2.0 and 3.0: the order of calls, and a state that can be copied and stored. */
#ifndef FMI_INSTANCE_H
#define FMI_INSTANCE_H

#include "car.h"

enum { LABEL = 256 };

/* Modes of the standards; the numbers are part of a stored state. */
enum { INSTANTIATED, INITIALIZATION, STEPPING, TERMINATED, FAILED };

typedef struct Instance {
  Motion state;
  char name[LABEL];
  char message[MESSAGE];           /* text of the last error or notice */
  int experiment;                  /* FMI 2: 1 after fmi2SetupExperiment */
  void *environment;
  void (*log)(struct Instance *self, int is_error, const char *text);
  void (*callback)(void);          /* function of the master that takes messages; `log` knows its type */
} Instance;

typedef struct {
  size_t size;
  double numbers[];
} Stored;

/* Functions that can be refused return 1, or 0 after a message to the master. */
Instance *new_instance(const char *name, const char *token, const char *resources, char *message);
void free_instance(Instance *self);
int fail(Instance *self, const char *format, ...);
int begin_initialization(Instance *self, double start_time);
int end_initialization(Instance *self);
int terminate_instance(Instance *self);
int reset_instance(Instance *self);
int get_values(Instance *self, const uint32_t *references, size_t count, double *values);
int set_values(Instance *self, const uint32_t *references, size_t count, const double *values);
int advance_instance(Instance *self, double point, double length);
int copy_state(Instance *self, Stored **stored);
int set_state(Instance *self, const Stored *stored);
size_t stored_size(const Instance *self);
int write_state(Instance *self, const Stored *stored, void *bytes, size_t size);
void free_stored(Stored **stored);
int read_state(Instance *self, const void *bytes, size_t size, Stored **stored);

#endif

/* A car, the state of an instance, and the functions on them.
 *
 * The car is the record Embedded of the core (vehicle/core/source/layout.h), as resources/car.bin has it; its motion is
 * the march of the core (march.c) in double precision. No number of a car is in this library. */
#ifndef CAR_H
#define CAR_H

#include <stddef.h>
#include <stdint.h>

#include "layout.h"

enum { MESSAGE = 400 };            /* size of the text of an error */
enum { TOKEN = 40 };               /* size of the text that ties a library call to its car */
enum { PARTS = 4, ROW = 32 };      /* numbers and bytes of a row of a table */

/* Parameters of a damper that may change during a run. The first four are fields of DamperLaw in their order. */
enum {
  PARAMETER_FRICTION,
  PARAMETER_STATIC_FRICTION,
  PARAMETER_STRIBECK_VELOCITY,
  PARAMETER_STRIBECK_EXPONENT,
  PARAMETER_CURVE_SCALE,
  PARAMETER_CONTROL,
  PARAMETERS
};

/* What an output reads besides its row; the index of its damper follows in `kinds`. */
enum { OUTPUT_LINEAR, OUTPUT_VELOCITY, OUTPUT_FORCE, OUTPUT_COEFFICIENT };

/* What acts on a damper in its last step: factor on the curve, coefficient and force from outside. */
enum { APPLIED_SCALE, APPLIED_COEFFICIENT, APPLIED_FORCE, APPLIED };

typedef struct {
  Embedded data;
  char token[TOKEN];
  int64_t states;                  /* of a sample: poles, forces, z' */
  void *content;
} Car;

/* State of an instance: `block` is one piece of memory, so that its copy is the whole state. */
typedef struct {
  Car *car;
  March march;                     /* with the memory of this instance */
  void *memory;
  size_t size;                     /* numbers in the block */
  double *block;
  double *time, *start_time, *steps; /* begin of the next step [s]; of the run [s]; steps done */
  double *parameter;               /* (dampers, PARAMETERS) */
  double *plate;                   /* inputs: z, z' of each plate, then 0, F of each applied force */
  double *slope_excess;            /* inputs: V tan(beta) - z' of the road [m/s]; (tyres) */
  double *command;                 /* inputs: force [N], coefficient [N s/m] of each damper */
  double *before;                  /* `plate` at the end of the last step */
  double *applied;                 /* (dampers, APPLIED) */
  double *end_force;               /* nonlinear force of each damper at the end of the last step [N] */
  double *frozen;                  /* communication steps in which a plate moved without velocity; (plates) */
  double *warned;                  /* 1 if the notice was given; (watched) */
  double *mode;                    /* of the order of calls, see fmi_instance.h */
  double *checked;                 /* time of the next check of watched quantities [s] */
} Motion;

/* car_data.c */
Car *car_from(const char *bytes, size_t size);
Car *read_car(const char *path, char *message);
void free_car(Car *car);

/* motion.c */
int make_state(Motion *s, Car *car);
void free_state(Motion *s);
void reset_state(Motion *s);
void set_at_rest(Motion *s);
int has_solution(const Motion *s, int64_t damper);
void apply_commands(Motion *s);
void advance(Motion *s, int64_t steps);
int is_finite(const Motion *s);
double output_value(const Motion *s, int64_t output);
int64_t new_notice(Motion *s);

/* instance.c */
int get_value(const Motion *s, uint32_t reference, double *value, char *message);
int set_value(Motion *s, uint32_t reference, double value, char *message);
int communication_step(Motion *s, double point, double length, char *message);

static inline int64_t damper_count(const Car *car) { return car->data.march.dampers; }
static inline int64_t force_count(const Car *car) { return car->data.forces.n[0]; }
/* Without the forces, which are plates of the march too. */
static inline int64_t plate_count(const Car *car) { return car->data.march.plates - force_count(car); }
static inline int64_t watched_count(const Car *car) { return car->data.limits.n[0]; }
static inline int64_t output_count(const Car *car) { return car->data.kinds.n[0]; }
static inline const char *notice_of(const Car *car, int64_t k) { return car->data.notices.at + k * car->data.notices.n[1]; }

#endif

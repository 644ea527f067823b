/* Numbers of a car, state of an instance, and the functions on them.
 *
 * The car is a sum over its poles; all nonlinear forces are damper forces. Equations, symbols and the order of the
 * operations are those of vehicle/engines/reduced (pole_model.py, step_factors.py, time_step.py, feedback.py) in double
 * precision. No number of a car is in this library: all of them are read from resources/car.bin. */
#ifndef CAR_H
#define CAR_H

#include <stddef.h>
#include <stdint.h>

enum { LANES = 4 };          /* poles are stored in multiples of this, filled up with zeros */
enum { MESSAGE = 400 };      /* size of the text of an error */
enum { NAME = 64, NOTICE = 160 }; /* sizes of texts in the file */
enum { TOKEN = 40 };         /* size of the text that ties a library call to its car */
enum { CONTROL_NUMBERS = 8, CONTROL_MEMORY = 3 };

/* Numbers of a damper in the file. */
enum { DAMPER_FRICTION_LAW, DAMPER_FULL, DAMPER_VISCOUS, DAMPER_REST_FORCE, DAMPER_CONTROL, DAMPER_NUMBERS };

/* Parameters of a damper that may change during a run; the first values are in the file. */
enum {
  PARAMETER_FRICTION,
  PARAMETER_STATIC_FRICTION,
  PARAMETER_STRIBECK_VELOCITY,
  PARAMETER_STRIBECK_EXPONENT,
  PARAMETER_CURVE_SCALE,
  PARAMETER_CONTROL,
  PARAMETERS
};

/* Friction laws: the codes of FRICTION_CODES in car_numbers.py. */
enum { COULOMB, STRIBECK, PRESLIDING, FRICTION_LAWS };

/* What an output reads besides its row; the index of its damper is in `damper` of the output. */
enum { OUTPUT_LINEAR, OUTPUT_VELOCITY, OUTPUT_FORCE, OUTPUT_COEFFICIENT, OUTPUT_KINDS };

/* Sizes, in the order of the file. */
typedef struct {
  int64_t pairs, reals;            /* pole pairs and real poles, multiples of LANES */
  int64_t dampers, plates;
  int64_t tyres;                   /* plates whose tyre loads act on the slope of the road: plates or 0 */
  int64_t heights;                 /* plates whose displacement is an input of slow poles: plates or 0 */
  int64_t controls;                /* controlled dampers */
  int64_t ring;                    /* length of the memory of delayed demands of a controlled damper */
  int64_t nodes;                   /* nodes of a damper law */
  int64_t iterations;              /* Gauss-Seidel iterations over the dampers */
  int64_t outputs;
  int64_t varying;                 /* 1 if a friction limit depends on the velocity */
  int64_t groups, elements;        /* groups of Jenkins elements of presliding friction, elements of each */
  int64_t watched;                 /* outputs after the others that must stay within limits */
} Sizes;

typedef struct {
  Sizes n;
  int64_t inputs, sensors, sums, states; /* of a step; tyres + 2 controls; solved + sensors; 2 pairs + reals */
  int64_t solved, direct_terms;    /* dampers + groups; forces, slopes, forces of groups, z', z */
  double step;                     /* h [s] */
  char token[TOKEN];
  const double *pair_change;       /* E - 1, real and imaginary parts; (2, pairs) */
  const double *pair_inputs;       /* (inputs, 2, pairs) */
  const double *pair_sums;         /* rows of damper velocities, strokes of groups, sensors; (sums, 2, pairs) */
  const double *real_change, *real_inputs, *real_sums;
  const double *slip;              /* z' at the end of a step to velocities and strokes; (solved, plates) */
  const double *level;             /* z at the end of a step to strokes; (groups, plates) */
  const double *gain, *ramp;       /* mean forces (solved, solved) and slopes (solved, dampers) to these */
  const double *law;               /* x, half of the curve without D v, friction over its limit; (dampers, nodes, 3) */
  const double *damper;            /* (dampers, DAMPER_NUMBERS) */
  const double *parameter;         /* (dampers, PARAMETERS) */
  const double *control;           /* records of controlled dampers; (controls, CONTROL_NUMBERS) */
  const double *spring, *share;    /* Jenkins elements: stiffness, share of the limit; (groups, elements) */
  const double *owner;             /* damper of each group; (groups) */
  const double *direct;            /* to sensors; (sensors, direct_terms) */
  const double *sensor_start;      /* z', z to sensors at rest; (sensors, 2 plates) */
  const double *start;             /* z', z to the states at rest; (2 plates, states) */
  const double *output_kind;       /* kind and damper; (outputs, 2) */
  const double *fixed;             /* static values; (outputs + watched) */
  const double *rows;              /* (outputs + watched, states + direct_terms) */
  const double *by_force;          /* damper forces at the same instant; (outputs + watched, dampers) */
  const double *by_tyre;           /* forces on slopes at the same instant; (outputs + watched, plates) */
  const double *limit;             /* lowest and highest value; (watched, 2) */
  const char *names;               /* of plates, then of dampers; (plates + dampers, NAME) */
  const char *notice;              /* what a value beyond its limits means; (watched, NOTICE) */
  void *content;
} Car;

/* State of an instance: one block of numbers, so that its copy is the whole state. */
typedef struct {
  Car *car;
  size_t size;                     /* numbers in the block */
  double *block;
  double *time, *start_time, *steps; /* begin of the next step [s]; of the run [s]; steps done */
  double *parameter;               /* (dampers, PARAMETERS) */
  double *plate;                   /* inputs: z, z' of each plate */
  double *slope_excess;            /* inputs: V tan(beta) - z' of the road [m/s]; (tyres) */
  double *command;                 /* inputs: force [N], coefficient [N s/m] of each damper */
  double *before;                  /* z, z' at the end of the last step */
  double *poles;                   /* states without the forces of the last step; (states) */
  double *force, *slope, *end_force; /* mean nonlinear forces of the last step, their slopes; at its end */
  double *pushed;                  /* force commands of the last step */
  double *group_force;             /* mean forces of the groups in the last step; (groups) */
  double *place, *element;         /* strokes (groups) and forces of the elements (groups, elements) now */
  double *velocity, *earlier, *hold, *stuck, *stick, *friction_limit;
  double *coefficient;             /* damping beyond the curve of the car in the last step [N s/m] */
  double *half_curve;              /* half of the curve at the nodes; (dampers, nodes) */
  double *sensor, *past;
  double *memory;                  /* of control laws; (controls, CONTROL_MEMORY + ring) */
  double *work;                    /* work space, without meaning between two steps */
  double *frozen;                  /* communication steps in which a plate moved without velocity; (plates) */
  double *warned;                  /* 1 if the notice was given; (watched) */
  double *mode;                    /* of the order of calls, see fmi_instance.h */
  double *checked;                 /* time of the next check of watched quantities [s] */
} State;

/* car_data.c */
Car *car_from(const char *bytes, size_t size);
Car *read_car(const char *path, char *message);
void free_car(Car *car);

/* time_step.c */
void set_at_rest(State *s);
void set_curves(State *s);
void time_step(State *s, const double *end);
double output_value(const State *s, int64_t output);

/* instance.c */
int make_state(State *s, Car *car);
void reset_state(State *s);
int get_value(const State *s, uint32_t reference, double *value, char *message);
int set_value(State *s, uint32_t reference, double value, char *message);
int communication_step(State *s, double point, double length, char *message);
int64_t new_notice(State *s);

#endif

/* File of the numbers of a car, written by car_numbers.py: the sizes, then the arrays in the order of `Car`. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "car.h"

static const char MAGIC[8] = {'V', 'E', 'H', 'F', 'M', 'U', '0', '2'};
enum { MOST = 100000000 };         /* numbers in a file; a larger count is a damaged file */

#ifdef _WIN32
#include <windows.h>
/* Paths are UTF-8, which fopen of Windows does not read. */
static FILE *open_file(const char *path) {
  wchar_t wide[4096];
  if (!MultiByteToWideChar(CP_UTF8, 0, path, -1, wide, 4096)) return NULL;
  return _wfopen(wide, L"rb");
}
#else
static FILE *open_file(const char *path) { return fopen(path, "rb"); }
#endif

static int read_sizes(FILE *file, Car *car) {
  char magic[sizeof MAGIC];
  int64_t *sizes = (int64_t *)&car->n;
  if (fread(magic, 1, sizeof magic, file) != sizeof magic || memcmp(magic, MAGIC, sizeof magic)) return 0;
  if (fread(car->token, 1, TOKEN, file) != TOKEN || car->token[TOKEN - 1]) return 0;
  if (fread(&car->step, sizeof(double), 1, file) != 1 || !(car->step > 0.0)) return 0;
  if (fread(&car->n, sizeof(Sizes), 1, file) != 1) return 0;
  for (size_t k = 0; k < sizeof(Sizes) / sizeof(int64_t); k++)
    if (sizes[k] < 0 || sizes[k] > 10000) return 0;
  return car->n.pairs % LANES == 0 && car->n.reals % LANES == 0 && car->n.nodes > 1 && car->n.plates > 0;
}

/* Place the arrays one behind the other, if `first` is not NULL; return their length. */
static int64_t place(Car *car, const double *first) {
  const Sizes *n = &car->n;
  int64_t length = 0, all = n->outputs + n->watched, d = n->dampers, m = n->plates;
  struct { const double **array; int64_t size; } arrays[] = {
    {&car->pair_change, 2 * n->pairs},
    {&car->pair_inputs, car->inputs * 2 * n->pairs},
    {&car->pair_sums, car->sums * 2 * n->pairs},
    {&car->real_change, n->reals},
    {&car->real_inputs, car->inputs * n->reals},
    {&car->real_sums, car->sums * n->reals},
    {&car->slip, d * m},
    {&car->gain, d * d},
    {&car->ramp, d * d},
    {&car->law, d * n->nodes * 3},
    {&car->damper, d * DAMPER_NUMBERS},
    {&car->parameter, d * PARAMETERS},
    {&car->control, n->controls * CONTROL_NUMBERS},
    {&car->direct, car->sensors * 2 * (d + m)},
    {&car->sensor_start, car->sensors * 2 * m},
    {&car->start, 2 * m * car->states},
    {&car->output_kind, 2 * n->outputs},
    {&car->fixed, all},
    {&car->rows, all * (car->states + 2 * (d + m))},
    {&car->by_force, all * d},
    {&car->by_tyre, all * m},
    {&car->limit, 2 * n->watched},
  };
  for (size_t k = 0; k < sizeof arrays / sizeof arrays[0]; k++) {
    if (first) *arrays[k].array = first + length;
    length += arrays[k].size;
  }
  return length;
}

static int is_consistent(const Car *car) {
  for (int64_t i = 0; i < car->n.dampers; i++) {
    double law = car->damper[i * DAMPER_NUMBERS + DAMPER_FRICTION_LAW];
    if (!(law >= 0.0 && (int)law < FRICTION_LAWS)) return 0;
    if (!(car->damper[i * DAMPER_NUMBERS + DAMPER_CONTROL] < (double)car->n.controls)) return 0;
  }
  for (int64_t o = 0; o < car->n.outputs; o++) {
    double kind = car->output_kind[2 * o], damper = car->output_kind[2 * o + 1];
    if (!(kind >= 0.0 && (int)kind < OUTPUT_KINDS)) return 0;
    if (kind > 0.0 && !(damper >= 0.0 && damper < (double)car->n.dampers)) return 0;
  }
  return 1;
}

Car *read_car(const char *path, char *message) {
  FILE *file = open_file(path);
  if (!file) {
    snprintf(message, MESSAGE, "cannot open %.300s; the resources of the FMU must be unpacked there", path);
    return NULL;
  }
  Car *car = calloc(1, sizeof(Car));
  int valid = car && read_sizes(file, car);
  if (valid) {
    const Sizes *n = &car->n;
    car->sensors = n->tyres + 2 * n->controls;
    car->sums = n->dampers + car->sensors;
    car->inputs = 2 * n->dampers + 2 * n->plates + n->tyres + n->heights;
    car->states = 2 * n->pairs + n->reals;
    int64_t count = place(car, NULL), names = (n->plates + n->dampers) * NAME;
    int64_t texts = names + n->watched * NOTICE;
    valid = count < MOST && (car->content = malloc((size_t)(8 * count + texts + 8))) != NULL;
    if (valid) {
      double *numbers = car->content;
      char *text = (char *)(numbers + count), rest;
      place(car, numbers);
      car->names = text;
      car->notice = text + names;
      valid = fread(numbers, 8, (size_t)count, file) == (size_t)count &&
              fread(text, 1, (size_t)texts, file) == (size_t)texts && fread(&rest, 1, 1, file) == 0 &&
              is_consistent(car);
      for (int64_t k = NAME - 1; valid && k < names; k += NAME) valid = text[k] == 0;
      for (int64_t k = names + NOTICE - 1; valid && k < texts; k += NOTICE) valid = text[k] == 0;
    }
  }
  fclose(file);
  if (valid) return car;
  snprintf(message, MESSAGE, "%.300s is damaged or of another version of this library; write the FMU again", path);
  free_car(car);
  return NULL;
}

void free_car(Car *car) {
  if (!car) return;
  free(car->content);
  free(car);
}

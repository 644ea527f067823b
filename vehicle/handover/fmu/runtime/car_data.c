/* File of the numbers of a car, written by car_numbers.py: the sizes, then the arrays in the order of `Car`. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "car.h"

static const char MAGIC[8] = {'V', 'E', 'H', 'F', 'M', 'U', '0', '3'};
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

/* Content that is not read yet. */
typedef struct { const char *first; size_t size; } Rest;

static int take(Rest *rest, void *destination, size_t size) {
  if (rest->size < size) return 0;
  memcpy(destination, rest->first, size);
  rest->first += size;
  rest->size -= size;
  return 1;
}

static int take_sizes(Rest *rest, Car *car) {
  char magic[sizeof MAGIC];
  int64_t *sizes = (int64_t *)&car->n;
  if (!take(rest, magic, sizeof magic) || memcmp(magic, MAGIC, sizeof magic)) return 0;
  if (!take(rest, car->token, TOKEN) || car->token[TOKEN - 1]) return 0;
  if (!take(rest, &car->step, sizeof(double)) || !(car->step > 0.0)) return 0;
  if (!take(rest, &car->n, sizeof(Sizes))) return 0;
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
    {&car->slip, car->solved * m},
    {&car->level, n->groups * m},
    {&car->gain, car->solved * car->solved},
    {&car->ramp, car->solved * d},
    {&car->law, d * n->nodes * 3},
    {&car->damper, d * DAMPER_NUMBERS},
    {&car->parameter, d * PARAMETERS},
    {&car->control, n->controls * CONTROL_NUMBERS},
    {&car->spring, n->groups * n->elements},
    {&car->share, n->groups * n->elements},
    {&car->owner, n->groups},
    {&car->direct, car->sensors * car->direct_terms},
    {&car->sensor_start, car->sensors * 2 * m},
    {&car->start, 2 * m * car->states},
    {&car->output_kind, 2 * n->outputs},
    {&car->fixed, all},
    {&car->rows, all * (car->states + car->direct_terms)},
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
  for (int64_t k = 0; k < car->n.groups; k++)
    if (!(car->owner[k] >= 0.0 && car->owner[k] < (double)car->n.dampers)) return 0;
  for (int64_t o = 0; o < car->n.outputs; o++) {
    double kind = car->output_kind[2 * o], damper = car->output_kind[2 * o + 1];
    if (!(kind >= 0.0 && (int)kind < OUTPUT_KINDS)) return 0;
    if (kind > 0.0 && !(damper >= 0.0 && damper < (double)car->n.dampers)) return 0;
  }
  return 1;
}

Car *car_from(const char *bytes, size_t size) {
  Rest rest = {bytes, size};
  Car *car = calloc(1, sizeof(Car));
  int valid = car && take_sizes(&rest, car);
  if (valid) {
    const Sizes *n = &car->n;
    car->sensors = n->tyres + 2 * n->controls;
    car->solved = n->dampers + n->groups;
    car->sums = car->solved + car->sensors;
    car->direct_terms = 2 * n->dampers + n->groups + 2 * n->plates;
    car->inputs = car->direct_terms + n->tyres + n->heights;
    car->states = 2 * n->pairs + n->reals;
    int64_t count = place(car, NULL), names = (n->plates + n->dampers) * NAME;
    int64_t texts = names + n->watched * NOTICE;
    size_t length = (size_t)(8 * count + texts);
    valid = count < MOST && rest.size == length && (car->content = malloc(length + 8)) != NULL;
    if (valid) {
      double *numbers = car->content;
      char *text = (char *)(numbers + count);
      take(&rest, numbers, length);
      place(car, numbers);
      car->names = text;
      car->notice = text + names;
      valid = is_consistent(car);
      for (int64_t k = NAME - 1; valid && k < names; k += NAME) valid = text[k] == 0;
      for (int64_t k = names + NOTICE - 1; valid && k < texts; k += NOTICE) valid = text[k] == 0;
    }
  }
  if (valid) return car;
  free_car(car);
  return NULL;
}

Car *read_car(const char *path, char *message) {
  FILE *file = open_file(path);
  if (!file) {
    snprintf(message, MESSAGE, "cannot open %.300s; the resources of the FMU must be unpacked there", path);
    return NULL;
  }
  long size = fseek(file, 0, SEEK_END) ? -1 : ftell(file);
  char *bytes = size > 0 && !fseek(file, 0, SEEK_SET) ? malloc((size_t)size) : NULL;
  Car *car = bytes && fread(bytes, 1, (size_t)size, file) == (size_t)size ? car_from(bytes, (size_t)size) : NULL;
  free(bytes);
  fclose(file);
  if (!car)
    snprintf(message, MESSAGE, "%.300s is damaged or of another version of this library; write the FMU again", path);
  return car;
}

void free_car(Car *car) {
  if (!car) return;
  free(car->content);
  free(car);
}

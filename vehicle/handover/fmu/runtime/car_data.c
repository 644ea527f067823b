/* File of a car, written by car_numbers.py: MAGIC, token, length, sum of the bytes after it, then the record Embedded and
 * its arrays, whose addresses are offsets from the beginning of the file. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "car.h"

static const char MAGIC[8] = {'V', 'E', 'H', 'F', 'M', 'U', '0', '5'};
typedef struct { char magic[8], token[TOKEN]; uint64_t length, sum; } Header;

/* Turn the offsets of the arrays into addresses. */
#define MOVE_double(field)
#define MOVE_int64_t(field)
#define MOVE_Sections(field)
#define MOVE_ARRAY(field) (field).at = (void *)(base + (uintptr_t)(field).at);
#define MOVE_Vector(field) MOVE_ARRAY(field)
#define MOVE_Table(field) MOVE_ARRAY(field)
#define MOVE_Tables3(field) MOVE_ARRAY(field)
#define MOVE_Index(field) MOVE_ARRAY(field)
#define MOVE_Indices(field) MOVE_ARRAY(field)
#define MOVE_Texts(field) MOVE_ARRAY(field)
#define MOVE_Records(field) MOVE_ARRAY(field)
#define MOVE_RecordTable(field) MOVE_ARRAY(field)
#define MOVE_Settings(field) MOVE_ARRAY(field)
#define MOVE_OwnLaws(field) MOVE_ARRAY(field) /* empty: an address means nothing in another process */
#define MOVE_Lanes(field) MOVE_ARRAY(field)
#define MOVE_Reals(field) MOVE_ARRAY(field)
#define MOVE_IN_MARCH(kind, name) MOVE_##kind(data->march.name)
#define MOVE_March(field) MARCH_FIELDS(MOVE_IN_MARCH)
#define MOVE(kind, name) MOVE_##kind(data->name)

static void set_addresses(Embedded *data, char *base) { EMBEDDED_FIELDS(MOVE) }

/* Return the car of the content of a file; NULL if it is of another version or length. */
Car *car_from(const char *bytes, size_t size) {
  Header header;
  if (size < sizeof header + sizeof(Embedded)) return NULL;
  memcpy(&header, bytes, sizeof header);
  if (memcmp(header.magic, MAGIC, sizeof MAGIC) || header.length != size || header.token[TOKEN - 1]) return NULL;
  Car *car = calloc(1, sizeof(Car));
  if (!car || !(car->content = malloc(size + ROW))) {
    free(car);
    return NULL;
  }
  char *base = (char *)car->content + (ROW - (uintptr_t)car->content % ROW) % ROW;
  memcpy(base, bytes, size);
  memcpy(&car->data, base + sizeof header, sizeof car->data);
  memcpy(car->token, header.token, TOKEN);
  set_addresses(&car->data, base);
  const March *march = &car->data.march;
  car->states = march->rows.states + 2 * march->dampers + march->rows.groups + march->rows.curves + march->plates;
  return car;
}

void free_car(Car *car) {
  if (!car) return;
  free(car->content);
  free(car);
}

#ifndef __wasm__ /* a page has the bytes, some of them rounded */
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

/* Sum of bytes of Fowler, Noll and Vo (FNV-1a, 64 bits), by words: it finds damage, not intent. */
static uint64_t sum_of(const char *bytes, size_t size) {
  uint64_t sum = 0xcbf29ce484222325, word;
  for (size_t k = 0; k + 8 <= size; k += 8) {
    memcpy(&word, bytes + k, 8);
    sum = (sum ^ word) * 0x100000001b3;
  }
  return sum;
}

static int is_whole(const char *bytes, size_t size) {
  Header header;
  if (size < sizeof header) return 0;
  memcpy(&header, bytes, sizeof header);
  return size % 8 == 0 && header.sum == sum_of(bytes + sizeof header, size - sizeof header);
}

Car *read_car(const char *path, char *message) {
  FILE *file = open_file(path);
  if (!file) {
    snprintf(message, MESSAGE, "cannot open %.300s; the resources of the FMU must be unpacked there", path);
    return NULL;
  }
  long size = fseek(file, 0, SEEK_END) ? -1 : ftell(file);
  char *bytes = size > 0 && !fseek(file, 0, SEEK_SET) ? malloc((size_t)size) : NULL;
  int whole = bytes && fread(bytes, 1, (size_t)size, file) == (size_t)size && is_whole(bytes, (size_t)size);
  Car *car = whole ? car_from(bytes, (size_t)size) : NULL;
  free(bytes);
  fclose(file);
  if (!car)
    snprintf(message, MESSAGE, "%.300s is damaged or of another version of this library; write the FMU again", path);
  return car;
}
#endif

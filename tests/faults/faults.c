/* Preloaded library that makes the n-th system call on files below a folder fail, or kills the process there.

   Counted are calls with a path or a descriptor below the folder of faults_arm; relative paths count, because the
   process works in that folder. A killed write writes half of its bytes first. close closes, and then fails. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/types.h>
#include <sys/uio.h>
#include <unistd.h>

enum { OPEN = 1, WRITE = 2, FSYNC = 4, RENAME = 8, UNLINK = 16, MMAP = 32, CLOSE = 64, MKDIR = 128, READ = 256 };

static char folder[PATH_MAX];
static size_t length;
static int armed, code, calls, lasting;
static long count, last;
static char called[PATH_MAX];
static FILE *list;

/* Write the kind and the path of each counted call to a file. */
void faults_list(const char *file) { list = fopen(file, "w"); }

/* Fail call number n of the kinds in `which` with `error`; 0 kills, a negative one only counts; all later calls of
   these kinds fail too if `all_later` is set, as on a full disk. */
void faults_arm(const char *below, int which, long n, int error, int all_later) {
    strncpy(folder, below, sizeof folder - 1);
    length = strlen(folder);
    calls = which, last = n, code = error, lasting = all_later, count = 0, armed = 1;
}

void faults_disarm(void) {
    armed = 0;
    if (list) fclose(list), list = NULL;
}

static int below(const char *path) {
    if (!armed || !path) return 0;
    if (list) strncpy(called, path, sizeof called - 1);
    return path[0] != '/' || (!strncmp(path, folder, length) && (path[length] == '/' || !path[length]));
}

static int below_descriptor(int descriptor) {
    char link[64], path[PATH_MAX];
    if (!armed || descriptor < 3) return 0;
    snprintf(link, sizeof link, "/proc/self/fd/%d", descriptor);
    ssize_t size = readlink(link, path, sizeof path - 1);
    if (size <= 0) return 0;
    path[size] = 0;
    return path[0] == '/' && below(path);
}

static int below_at(int descriptor, const char *path) {
    return path && path[0] != '/' && descriptor != AT_FDCWD ? below_descriptor(descriptor) : below(path);
}

/* 1 if this call fails now, with errno set. */
static int fails(int kind) {
    if (!(kind & calls)) return 0;
    if (list) fprintf(list, "%d %s\n", kind, called);
    long number = __sync_add_and_fetch(&count, 1);
    if (code < 0 || !(number == last || (lasting && number > last))) return 0;
    if (code == 0) kill(getpid(), SIGKILL);
    errno = code;
    return 1;
}

#define REAL(name, type) static __typeof__(type) real; if (!real) real = (__typeof__(type))dlsym(RTLD_NEXT, name)

#define OPENS(name)                                                                  \
    int name(const char *path, int flags, ...) {                                     \
        REAL(#name, int (*)(const char *, int, ...));                                \
        va_list rest; va_start(rest, flags); mode_t mode = va_arg(rest, mode_t); va_end(rest); \
        if (below(path) && fails(flags & (O_CREAT | O_WRONLY | O_RDWR) ? OPEN : READ)) return -1; \
        return real(path, flags, mode);                                              \
    }
OPENS(open)
OPENS(open64)

#define OPENS_AT(name)                                                               \
    int name(int at, const char *path, int flags, ...) {                             \
        REAL(#name, int (*)(int, const char *, int, ...));                           \
        va_list rest; va_start(rest, flags); mode_t mode = va_arg(rest, mode_t); va_end(rest); \
        if (below_at(at, path) && fails(flags & (O_CREAT | O_WRONLY | O_RDWR) ? OPEN : READ)) return -1; \
        return real(at, path, flags, mode);                                          \
    }
OPENS_AT(openat)
OPENS_AT(openat64)

#define FOPENS(name)                                                                 \
    FILE *name(const char *path, const char *mode) {                                 \
        REAL(#name, FILE *(*)(const char *, const char *));                          \
        if (below(path) && fails(mode[0] == 'r' ? READ : OPEN)) return NULL;    \
        return real(path, mode);                                                     \
    }
FOPENS(fopen)
FOPENS(fopen64)

ssize_t write(int descriptor, const void *data, size_t size) {
    REAL("write", ssize_t (*)(int, const void *, size_t));
    if (below_descriptor(descriptor)) {
        if (code == 0 && (calls & WRITE) && count + 1 == last) real(descriptor, data, size / 2);
        if (fails(WRITE)) return -1;
    }
    return real(descriptor, data, size);
}

#define PWRITES(name, offset_type)                                                   \
    ssize_t name(int descriptor, const void *data, size_t size, offset_type at) {    \
        REAL(#name, ssize_t (*)(int, const void *, size_t, offset_type));            \
        if (below_descriptor(descriptor) && fails(WRITE)) return -1;                 \
        return real(descriptor, data, size, at);                                     \
    }
PWRITES(pwrite, off_t)
PWRITES(pwrite64, off64_t)

ssize_t writev(int descriptor, const struct iovec *parts, int number) {
    REAL("writev", ssize_t (*)(int, const struct iovec *, int));
    if (below_descriptor(descriptor) && fails(WRITE)) return -1;
    return real(descriptor, parts, number);
}

ssize_t sendfile(int out, int in, off_t *offset, size_t size) {
    REAL("sendfile", ssize_t (*)(int, int, off_t *, size_t));
    if (below_descriptor(out) && fails(WRITE)) return -1;
    return real(out, in, offset, size);
}

ssize_t copy_file_range(int in, off64_t *from, int out, off64_t *to, size_t size, unsigned flags) {
    REAL("copy_file_range", ssize_t (*)(int, off64_t *, int, off64_t *, size_t, unsigned));
    if (below_descriptor(out) && fails(WRITE)) return -1;
    return real(in, from, out, to, size, flags);
}

#define OF_DESCRIPTOR(name, kind)                                                    \
    int name(int descriptor) {                                                       \
        REAL(#name, int (*)(int));                                                   \
        if (below_descriptor(descriptor) && fails(kind)) return -1;                  \
        return real(descriptor);                                                     \
    }
OF_DESCRIPTOR(fsync, FSYNC)
OF_DESCRIPTOR(fdatasync, FSYNC)

int close(int descriptor) {
    REAL("close", int (*)(int));
    int ours = below_descriptor(descriptor), saved;
    if (ours && fails(CLOSE)) {
        saved = errno, real(descriptor), errno = saved;
        return -1;
    }
    return real(descriptor);
}

#define TRUNCATES(name, offset_type)                                                 \
    int name(int descriptor, offset_type size) {                                     \
        REAL(#name, int (*)(int, offset_type));                                      \
        if (below_descriptor(descriptor) && fails(WRITE)) return -1;                 \
        return real(descriptor, size);                                               \
    }
TRUNCATES(ftruncate, off_t)
TRUNCATES(ftruncate64, off64_t)

int rename(const char *old, const char *new) {
    REAL("rename", int (*)(const char *, const char *));
    if (below(new) && fails(RENAME)) return -1;
    return real(old, new);
}

int renameat(int first, const char *old, int second, const char *new) {
    REAL("renameat", int (*)(int, const char *, int, const char *));
    if (below_at(second, new) && fails(RENAME)) return -1;
    return real(first, old, second, new);
}

int renameat2(int first, const char *old, int second, const char *new, unsigned flags) {
    REAL("renameat2", int (*)(int, const char *, int, const char *, unsigned));
    if (below_at(second, new) && fails(RENAME)) return -1;
    return real(first, old, second, new, flags);
}

#define OF_PATH(name, kind)                                                          \
    int name(const char *path) {                                                     \
        REAL(#name, int (*)(const char *));                                          \
        if (below(path) && fails(kind)) return -1;                                   \
        return real(path);                                                           \
    }
OF_PATH(unlink, UNLINK)
OF_PATH(rmdir, UNLINK)

int unlinkat(int at, const char *path, int flags) {
    REAL("unlinkat", int (*)(int, const char *, int));
    if (below_at(at, path) && fails(UNLINK)) return -1;
    return real(at, path, flags);
}

int mkdir(const char *path, mode_t mode) {
    REAL("mkdir", int (*)(const char *, mode_t));
    if (below(path) && fails(MKDIR)) return -1;
    return real(path, mode);
}

#define MMAPS(name, offset_type)                                                     \
    void *name(void *at, size_t size, int protection, int flags, int descriptor, offset_type offset) { \
        REAL(#name, void *(*)(void *, size_t, int, int, int, offset_type));          \
        if (below_descriptor(descriptor) && fails(MMAP)) return MAP_FAILED;          \
        return real(at, size, protection, flags, descriptor, offset);                \
    }
MMAPS(mmap, off_t)
MMAPS(mmap64, off64_t)

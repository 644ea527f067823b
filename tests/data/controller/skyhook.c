/* Skyhook controller of a damper as an FMU, FMI 2.0 and 3.0 co-simulation in one library.

   cc -O2 -shared -fPIC -ffp-contract=off -o skyhook.so skyhook.c -lm; that of the tests by tools/controller_library.py

   c = clamp(max(c_sky vb sign(v), 0), cmin |v|, cmax |v|) / |v| with v = vb - vw, softest at rest: the law `skyhook` of
   vehicle/model/laws/control_laws.py in the same order of operations. A value of FAULT makes it fail, for tests. */

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#ifdef _WIN32
#define EXPORT __declspec(dllexport)
#else
#define EXPORT __attribute__((visibility("default")))
#endif

enum { OK, WARNING, DISCARD, ERROR };
enum { BODY, WHEEL, GAIN, SOFTEST, FIRMEST, COEFFICIENT, FAULT, BODY_ACCELERATION, WHEEL_ACCELERATION, DIFFERENCE, SIZE };

typedef void (*Logger2)(void *, const char *, int, const char *, const char *, ...);
typedef void (*Logger3)(void *, int, const char *, const char *);
typedef struct {
    Logger2 log;
    void *(*allocate)(size_t, size_t);
    void (*release)(void *);
    void *step_finished, *environment;
} Callbacks;
typedef struct {
    double values[SIZE];
    Logger2 log2;
    Logger3 log3;
    void *environment;
} Controller;

static const char TOKEN[] = "{skyhook-1}", TOO_LATE[] = "the controller fails from 0.1 s on";

static int transfer(double *values, double *others, const uint32_t *references, size_t count, bool read) {
    for (size_t n = 0; n < count; n++) {
        if (references[n] >= SIZE) return ERROR;
        if (read) others[n] = values[references[n]];
        else values[references[n]] = others[n];
    }
    return OK;
}

static int step(Controller *c, double time, double length, bool *terminate) {
    double *v = c->values, difference = v[BODY] - v[WHEEL], speed = fabs(difference);
    double way = (difference > 0.0) - (difference < 0.0), force = v[GAIN] * fmax(v[BODY] * way, 0.0);
    double near = fmin(fmax(force, v[SOFTEST] * speed), v[FIRMEST] * speed);
    v[COEFFICIENT] = fmin(fmax(near / (speed + (speed == 0.0)), v[SOFTEST]), v[FIRMEST]);
    *terminate = false;
    if (v[FAULT] == 0.0 || time + 0.5 * length < 0.1) return OK;
    if (v[FAULT] == 0.25) v[COEFFICIENT] = NAN;
    if (v[FAULT] == 0.5) *terminate = true;
    if (v[FAULT] != 0.75) return OK;
    if (c->log2) c->log2(c->environment, "skyhook", ERROR, "logStatusError", TOO_LATE);
    if (c->log3) c->log3(c->environment, ERROR, "logStatusError", TOO_LATE);
    return ERROR;
}

static Controller *instantiate(const char *token) {
    Controller *c = strcmp(token, TOKEN) == 0 ? calloc(1, sizeof *c) : NULL;
    if (c) c->values[GAIN] = 1000.0, c->values[SOFTEST] = 100.0, c->values[FIRMEST] = 10000.0;
    return c;
}

/* FMI 2.0 */
EXPORT const char *fmi2GetTypesPlatform(void) { return "default"; }
EXPORT const char *fmi2GetVersion(void) { return "2.0"; }
EXPORT void *fmi2Instantiate(const char *name, int type, const char *guid, const char *resources,
                             const Callbacks *callbacks, int visible, int logging) {
    (void)name, (void)type, (void)resources, (void)visible, (void)logging;
    Controller *c = instantiate(guid);
    if (c) c->log2 = callbacks->log, c->environment = callbacks->environment;
    return c;
}
EXPORT void fmi2FreeInstance(void *c) { free(c); }
EXPORT int fmi2SetupExperiment(void *c, int with_tolerance, double tolerance, double start, int with_stop, double stop) {
    (void)c, (void)with_tolerance, (void)tolerance, (void)start, (void)with_stop, (void)stop;
    return OK;
}
EXPORT int fmi2EnterInitializationMode(void *c) { return c ? OK : ERROR; }
EXPORT int fmi2ExitInitializationMode(void *c) { return c ? OK : ERROR; }
EXPORT int fmi2Terminate(void *c) { return c ? OK : ERROR; }
EXPORT int fmi2SetReal(void *c, const uint32_t *references, size_t count, const double *values) {
    return transfer(((Controller *)c)->values, (double *)values, references, count, false);
}
EXPORT int fmi2GetReal(void *c, const uint32_t *references, size_t count, double *values) {
    return transfer(((Controller *)c)->values, values, references, count, true);
}
EXPORT int fmi2DoStep(void *c, double time, double length, int no_reset) {
    bool terminate;
    (void)no_reset;
    return step(c, time, length, &terminate);
}

/* FMI 3.0 */
EXPORT const char *fmi3GetVersion(void) { return "3.0"; }
EXPORT void *fmi3InstantiateCoSimulation(const char *name, const char *token, const char *resources, bool visible,
                                         bool logging, bool events, bool early, const uint32_t *required, size_t count,
                                         void *environment, Logger3 log, void *intermediate) {
    (void)name, (void)resources, (void)visible, (void)logging, (void)events, (void)early;
    (void)required, (void)count, (void)intermediate;
    Controller *c = instantiate(token);
    if (c) c->log3 = log, c->environment = environment;
    return c;
}
EXPORT void fmi3FreeInstance(void *c) { free(c); }
EXPORT int fmi3EnterInitializationMode(void *c, bool with_tolerance, double tolerance, double start, bool with_stop,
                                       double stop) {
    (void)with_tolerance, (void)tolerance, (void)start, (void)with_stop, (void)stop;
    return c ? OK : ERROR;
}
EXPORT int fmi3ExitInitializationMode(void *c) { return c ? OK : ERROR; }
EXPORT int fmi3Terminate(void *c) { return c ? OK : ERROR; }
EXPORT int fmi3SetFloat64(void *c, const uint32_t *references, size_t count, const double *values, size_t size) {
    return count == size ? transfer(((Controller *)c)->values, (double *)values, references, count, false) : ERROR;
}
EXPORT int fmi3GetFloat64(void *c, const uint32_t *references, size_t count, double *values, size_t size) {
    return count == size ? transfer(((Controller *)c)->values, values, references, count, true) : ERROR;
}
EXPORT int fmi3DoStep(void *c, double time, double length, bool no_reset, bool *event, bool *terminate, bool *early,
                      double *last) {
    (void)no_reset;
    *event = *early = false;
    *last = time + length;
    return step(c, time, length, terminate);
}

/* A library has all functions of the standard; the controller does without these. */
#define ABSENT(name) EXPORT int name(void) { return ERROR; }
ABSENT(fmi2CancelStep) ABSENT(fmi2DeSerializeFMUstate) ABSENT(fmi2FreeFMUstate) ABSENT(fmi2GetBoolean)
ABSENT(fmi2GetBooleanStatus) ABSENT(fmi2GetDirectionalDerivative) ABSENT(fmi2GetFMUstate) ABSENT(fmi2GetInteger)
ABSENT(fmi2GetIntegerStatus) ABSENT(fmi2GetRealOutputDerivatives) ABSENT(fmi2GetRealStatus) ABSENT(fmi2GetStatus)
ABSENT(fmi2GetString) ABSENT(fmi2GetStringStatus) ABSENT(fmi2Reset) ABSENT(fmi2SerializeFMUstate)
ABSENT(fmi2SerializedFMUstateSize) ABSENT(fmi2SetBoolean) ABSENT(fmi2SetDebugLogging) ABSENT(fmi2SetFMUstate)
ABSENT(fmi2SetInteger) ABSENT(fmi2SetRealInputDerivatives) ABSENT(fmi2SetString)
ABSENT(fmi3ActivateModelPartition) ABSENT(fmi3CompletedIntegratorStep) ABSENT(fmi3DeserializeFMUState)
ABSENT(fmi3EnterConfigurationMode) ABSENT(fmi3EnterContinuousTimeMode) ABSENT(fmi3EnterEventMode)
ABSENT(fmi3EnterStepMode) ABSENT(fmi3EvaluateDiscreteStates) ABSENT(fmi3ExitConfigurationMode)
ABSENT(fmi3FreeFMUState) ABSENT(fmi3GetAdjointDerivative) ABSENT(fmi3GetBinary) ABSENT(fmi3GetBoolean)
ABSENT(fmi3GetClock) ABSENT(fmi3GetContinuousStateDerivatives) ABSENT(fmi3GetContinuousStates)
ABSENT(fmi3GetDirectionalDerivative) ABSENT(fmi3GetEventIndicators) ABSENT(fmi3GetFMUState) ABSENT(fmi3GetFloat32)
ABSENT(fmi3GetInt16) ABSENT(fmi3GetInt32) ABSENT(fmi3GetInt64) ABSENT(fmi3GetInt8) ABSENT(fmi3GetIntervalDecimal)
ABSENT(fmi3GetIntervalFraction) ABSENT(fmi3GetNominalsOfContinuousStates) ABSENT(fmi3GetNumberOfContinuousStates)
ABSENT(fmi3GetNumberOfEventIndicators) ABSENT(fmi3GetNumberOfVariableDependencies)
ABSENT(fmi3GetOutputDerivatives) ABSENT(fmi3GetShiftDecimal) ABSENT(fmi3GetShiftFraction) ABSENT(fmi3GetString)
ABSENT(fmi3GetUInt16) ABSENT(fmi3GetUInt32) ABSENT(fmi3GetUInt64) ABSENT(fmi3GetUInt8)
ABSENT(fmi3GetVariableDependencies) ABSENT(fmi3InstantiateModelExchange) ABSENT(fmi3InstantiateScheduledExecution)
ABSENT(fmi3Reset) ABSENT(fmi3SerializeFMUState) ABSENT(fmi3SerializedFMUStateSize) ABSENT(fmi3SetBinary)
ABSENT(fmi3SetBoolean) ABSENT(fmi3SetClock) ABSENT(fmi3SetContinuousStates) ABSENT(fmi3SetDebugLogging)
ABSENT(fmi3SetFMUState) ABSENT(fmi3SetFloat32) ABSENT(fmi3SetInt16) ABSENT(fmi3SetInt32) ABSENT(fmi3SetInt64)
ABSENT(fmi3SetInt8) ABSENT(fmi3SetIntervalDecimal) ABSENT(fmi3SetIntervalFraction) ABSENT(fmi3SetShiftDecimal)
ABSENT(fmi3SetShiftFraction) ABSENT(fmi3SetString) ABSENT(fmi3SetTime) ABSENT(fmi3SetUInt16) ABSENT(fmi3SetUInt32)
ABSENT(fmi3SetUInt64) ABSENT(fmi3SetUInt8) ABSENT(fmi3UpdateDiscreteStates)

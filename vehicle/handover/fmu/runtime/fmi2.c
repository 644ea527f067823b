/* FMI 2.0 co-simulation. Functions for options that the model description does not offer refuse with a message. */
#include <stdio.h>
#include <string.h>

#include "fmi_instance.h"
#include "fmi_types.h"

static fmi2Status status(int accepted) { return accepted ? fmi2OK : fmi2Error; }

static fmi2Status missing(fmi2Component c, const char *function) {
  return c ? status(fail(c, "%s: not offered by this FMU, see its model description", function)) : fmi2Error;
}

static void log_message(Instance *self, int is_error, const char *text) {
  fmi2CallbackLogger logger = (fmi2CallbackLogger)self->callback;
  if (logger)
    logger(self->environment, self->name, is_error ? fmi2Error : fmi2Warning,
           is_error ? "logStatusError" : "logStatusWarning", "%s", text);
}

static int digit(char letter) {
  if (letter >= '0' && letter <= '9') return letter - '0';
  if (letter >= 'a' && letter <= 'f') return letter - 'a' + 10;
  return letter >= 'A' && letter <= 'F' ? letter - 'A' + 10 : -1;
}

/* Path of a file URI: file:///C:/my%20car gives C:/my car, file:///tmp/car gives /tmp/car. */
static void path_of(const char *uri, char *path, size_t size) {
  size_t length = 0;
  const char *from = uri;
  if (!strncmp(from, "file:", 5)) {
    from += 5;
    if (!strncmp(from, "//localhost/", 12)) from += 11;
    else if (!strncmp(from, "///", 3)) from += 2;
    if (from[0] == '/' && from[1] && from[2] == ':') from++;
  }
  for (; *from && length < size - 1; from++) {
    int high = *from == '%' ? digit(from[1]) : -1, low = high >= 0 ? digit(from[2]) : -1;
    path[length++] = low >= 0 ? (char)(16 * high + low) : *from;
    if (low >= 0) from += 2;
  }
  path[length] = 0;
}

EXPORT const char *fmi2GetTypesPlatform(void) { return "default"; }
EXPORT const char *fmi2GetVersion(void) { return "2.0"; }

EXPORT fmi2Status fmi2SetDebugLogging(fmi2Component c, fmi2Boolean on, size_t count, const fmi2String categories[]) {
  (void)on, (void)count, (void)categories; /* errors and warnings are always given to the logger */
  return c ? fmi2OK : fmi2Error;
}

EXPORT fmi2Component fmi2Instantiate(fmi2String name, fmi2Type type, fmi2String token, fmi2String resources,
                                     const fmi2CallbackFunctions *functions, fmi2Boolean visible, fmi2Boolean logging) {
  char message[MESSAGE] = "only co-simulation is offered by this FMU", path[4096] = "";
  Instance *self = NULL;
  (void)visible, (void)logging;
  if (resources) path_of(resources, path, sizeof path);
  if (type == fmi2CoSimulation) self = new_instance(name, token, path, message);
  if (!self) {
    if (functions && functions->logger)
      functions->logger(functions->componentEnvironment, name ? name : "", fmi2Error, "logStatusError", "%s", message);
    return NULL;
  }
  self->log = log_message;
  if (functions) {
    self->callback = (void (*)(void))functions->logger;
    self->environment = functions->componentEnvironment;
  }
  return self;
}

EXPORT void fmi2FreeInstance(fmi2Component c) { free_instance(c); }

EXPORT fmi2Status fmi2SetupExperiment(fmi2Component c, fmi2Boolean has_tolerance, fmi2Real tolerance, fmi2Real start,
                                      fmi2Boolean has_stop, fmi2Real stop) {
  Instance *self = c;
  (void)has_tolerance, (void)tolerance, (void)has_stop, (void)stop;
  if (!self) return fmi2Error;
  if ((int)self->state.mode[0] != INSTANTIATED)
    return status(fail(self, "set up experiment: must be called before initialization"));
  self->state.start_time[0] = start;
  self->experiment = 1;
  return fmi2OK;
}

EXPORT fmi2Status fmi2EnterInitializationMode(fmi2Component c) {
  Instance *self = c;
  if (!self) return fmi2Error;
  if ((int)self->state.mode[0] == INSTANTIATED && !self->experiment)
    return status(fail(self, "enter initialization mode: fmi2SetupExperiment must be called before"));
  return status(begin_initialization(self, self->state.start_time[0]));
}

EXPORT fmi2Status fmi2ExitInitializationMode(fmi2Component c) { return status(c && end_initialization(c)); }
EXPORT fmi2Status fmi2Terminate(fmi2Component c) { return status(c && terminate_instance(c)); }
EXPORT fmi2Status fmi2Reset(fmi2Component c) { return status(c && reset_instance(c)); }

EXPORT fmi2Status fmi2GetReal(fmi2Component c, const fmi2ValueReference r[], size_t n, fmi2Real values[]) {
  return status(c && get_values(c, r, n, values));
}
EXPORT fmi2Status fmi2SetReal(fmi2Component c, const fmi2ValueReference r[], size_t n, const fmi2Real values[]) {
  return status(c && set_values(c, r, n, values));
}

#define NO_VARIABLES(type)                                                                                          \
  EXPORT fmi2Status fmi2Get##type(fmi2Component c, const fmi2ValueReference r[], size_t n, fmi2##type values[]) {   \
    (void)r, (void)values;                                                                                          \
    return c && !n ? fmi2OK : missing(c, "fmi2Get" #type);                                                          \
  }                                                                                                                 \
  EXPORT fmi2Status fmi2Set##type(fmi2Component c, const fmi2ValueReference r[], size_t n, const fmi2##type values[]) { \
    (void)r, (void)values;                                                                                          \
    return c && !n ? fmi2OK : missing(c, "fmi2Set" #type);                                                          \
  }
NO_VARIABLES(Integer)
NO_VARIABLES(Boolean)
NO_VARIABLES(String)

EXPORT fmi2Status fmi2GetFMUstate(fmi2Component c, fmi2FMUstate *state) {
  return status(c && copy_state(c, (Stored **)state));
}
EXPORT fmi2Status fmi2SetFMUstate(fmi2Component c, fmi2FMUstate state) { return status(c && set_state(c, state)); }
EXPORT fmi2Status fmi2FreeFMUstate(fmi2Component c, fmi2FMUstate *state) {
  if (!c) return fmi2Error;
  free_stored((Stored **)state);
  return fmi2OK;
}
EXPORT fmi2Status fmi2SerializedFMUstateSize(fmi2Component c, fmi2FMUstate state, size_t *size) {
  if (!c || !state || !size) return fmi2Error;
  *size = stored_size(c);
  return fmi2OK;
}
EXPORT fmi2Status fmi2SerializeFMUstate(fmi2Component c, fmi2FMUstate state, fmi2Byte bytes[], size_t size) {
  return status(c && write_state(c, state, bytes, size));
}
EXPORT fmi2Status fmi2DeSerializeFMUstate(fmi2Component c, const fmi2Byte bytes[], size_t size, fmi2FMUstate *state) {
  return status(c && read_state(c, bytes, size, (Stored **)state));
}

EXPORT fmi2Status fmi2GetDirectionalDerivative(fmi2Component c, const fmi2ValueReference unknown[], size_t unknowns,
                                               const fmi2ValueReference known[], size_t knowns, const fmi2Real seed[],
                                               fmi2Real derivative[]) {
  (void)unknown, (void)unknowns, (void)known, (void)knowns, (void)seed, (void)derivative;
  return missing(c, "fmi2GetDirectionalDerivative");
}
EXPORT fmi2Status fmi2SetRealInputDerivatives(fmi2Component c, const fmi2ValueReference r[], size_t n,
                                              const fmi2Integer order[], const fmi2Real values[]) {
  (void)r, (void)n, (void)order, (void)values;
  return missing(c, "fmi2SetRealInputDerivatives");
}
EXPORT fmi2Status fmi2GetRealOutputDerivatives(fmi2Component c, const fmi2ValueReference r[], size_t n,
                                               const fmi2Integer order[], fmi2Real values[]) {
  (void)r, (void)n, (void)order, (void)values;
  return missing(c, "fmi2GetRealOutputDerivatives");
}

EXPORT fmi2Status fmi2DoStep(fmi2Component c, fmi2Real point, fmi2Real length, fmi2Boolean keeps_no_state) {
  (void)keeps_no_state;
  return status(c && advance_instance(c, point, length));
}
EXPORT fmi2Status fmi2CancelStep(fmi2Component c) { return missing(c, "fmi2CancelStep"); }

/* Steps are never pending: a status is known only for the time that was reached. */
EXPORT fmi2Status fmi2GetRealStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Real *value) {
  if (!c || !value || kind != fmi2LastSuccessfulTime) return missing(c, "fmi2GetRealStatus");
  *value = ((Instance *)c)->state.time[0];
  return fmi2OK;
}
#define NO_STATUS(name, type)                                                                       \
  EXPORT fmi2Status fmi2Get##name(fmi2Component c, const fmi2StatusKind kind, type *value) {        \
    (void)kind, (void)value;                                                                        \
    return missing(c, "fmi2Get" #name);                                                             \
  }
NO_STATUS(Status, fmi2Status)
NO_STATUS(IntegerStatus, fmi2Integer)
NO_STATUS(BooleanStatus, fmi2Boolean)
NO_STATUS(StringStatus, fmi2String)

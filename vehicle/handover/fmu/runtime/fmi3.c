/* FMI 3.0 co-simulation. Functions for options that the model description does not offer refuse with a message. */
#include <stdio.h>

#include "fmi_instance.h"
#include "fmi_types.h"

static fmi3Status status(int accepted) { return accepted ? fmi3OK : fmi3Error; }

static fmi3Status missing(fmi3Instance c, const char *function) {
  return c ? status(fail(c, "%s: not offered by this FMU, see its model description", function)) : fmi3Error;
}

static void log_message(Instance *self, int is_error, const char *text) {
  fmi3LogMessageCallback logger = (fmi3LogMessageCallback)self->callback;
  if (logger)
    logger(self->environment, is_error ? fmi3Error : fmi3Warning, is_error ? "logStatusError" : "logStatusWarning",
           text);
}

EXPORT const char *fmi3GetVersion(void) { return "3.0"; }

EXPORT fmi3Status fmi3SetDebugLogging(fmi3Instance c, fmi3Boolean on, size_t count, const fmi3String categories[]) {
  (void)on, (void)count, (void)categories; /* errors and warnings are always given to the logger */
  return c ? fmi3OK : fmi3Error;
}

EXPORT fmi3Instance fmi3InstantiateCoSimulation(
    fmi3String name, fmi3String token, fmi3String resources, fmi3Boolean visible, fmi3Boolean logging,
    fmi3Boolean event_mode, fmi3Boolean early_return, const fmi3ValueReference intermediate[], size_t intermediates,
    fmi3InstanceEnvironment environment, fmi3LogMessageCallback logger, fmi3IntermediateUpdateCallback update) {
  char message[MESSAGE] = "event mode and intermediate variables are not offered by this FMU";
  (void)visible, (void)logging, (void)early_return, (void)intermediate, (void)update;
  Instance *self = event_mode || intermediates ? NULL : new_instance(name, token, resources, message);
  if (!self) {
    if (logger) logger(environment, fmi3Error, "logStatusError", message);
    return NULL;
  }
  self->log = log_message;
  self->callback = (void (*)(void))logger;
  self->environment = environment;
  return self;
}

static fmi3Instance only_co_simulation(fmi3InstanceEnvironment environment, fmi3LogMessageCallback logger) {
  if (logger) logger(environment, fmi3Error, "logStatusError", "only co-simulation is offered by this FMU");
  return NULL;
}

EXPORT fmi3Instance fmi3InstantiateModelExchange(fmi3String name, fmi3String token, fmi3String resources,
                                                 fmi3Boolean visible, fmi3Boolean logging,
                                                 fmi3InstanceEnvironment environment, fmi3LogMessageCallback logger) {
  (void)name, (void)token, (void)resources, (void)visible, (void)logging;
  return only_co_simulation(environment, logger);
}

EXPORT fmi3Instance fmi3InstantiateScheduledExecution(
    fmi3String name, fmi3String token, fmi3String resources, fmi3Boolean visible, fmi3Boolean logging,
    fmi3InstanceEnvironment environment, fmi3LogMessageCallback logger, fmi3ClockUpdateCallback update,
    fmi3LockPreemptionCallback lock, fmi3UnlockPreemptionCallback unlock) {
  (void)name, (void)token, (void)resources, (void)visible, (void)logging, (void)update, (void)lock, (void)unlock;
  return only_co_simulation(environment, logger);
}

EXPORT void fmi3FreeInstance(fmi3Instance c) { free_instance(c); }

EXPORT fmi3Status fmi3EnterInitializationMode(fmi3Instance c, fmi3Boolean has_tolerance, fmi3Float64 tolerance,
                                              fmi3Float64 start, fmi3Boolean has_stop, fmi3Float64 stop) {
  (void)has_tolerance, (void)tolerance, (void)has_stop, (void)stop;
  return status(c && begin_initialization(c, start));
}
EXPORT fmi3Status fmi3ExitInitializationMode(fmi3Instance c) { return status(c && end_initialization(c)); }
EXPORT fmi3Status fmi3Terminate(fmi3Instance c) { return status(c && terminate_instance(c)); }
EXPORT fmi3Status fmi3Reset(fmi3Instance c) { return status(c && reset_instance(c)); }

EXPORT fmi3Status fmi3GetFloat64(fmi3Instance c, const fmi3ValueReference r[], size_t n, fmi3Float64 values[],
                                 size_t size) {
  if (c && n != size) return status(fail(c, "fmi3GetFloat64: %u values for %u references", (unsigned)size, (unsigned)n));
  return status(c && get_values(c, r, n, values));
}
EXPORT fmi3Status fmi3SetFloat64(fmi3Instance c, const fmi3ValueReference r[], size_t n, const fmi3Float64 values[],
                                 size_t size) {
  if (c && n != size) return status(fail(c, "fmi3SetFloat64: %u values for %u references", (unsigned)size, (unsigned)n));
  return status(c && set_values(c, r, n, values));
}

#define NO_VARIABLES(type)                                                                                         \
  EXPORT fmi3Status fmi3Get##type(fmi3Instance c, const fmi3ValueReference r[], size_t n, fmi3##type values[],     \
                                  size_t size) {                                                                   \
    (void)r, (void)values, (void)size;                                                                             \
    return c && !n ? fmi3OK : missing(c, "fmi3Get" #type);                                                         \
  }                                                                                                                \
  EXPORT fmi3Status fmi3Set##type(fmi3Instance c, const fmi3ValueReference r[], size_t n, const fmi3##type values[], \
                                  size_t size) {                                                                   \
    (void)r, (void)values, (void)size;                                                                             \
    return c && !n ? fmi3OK : missing(c, "fmi3Set" #type);                                                         \
  }
NO_VARIABLES(Float32)
NO_VARIABLES(Int8)
NO_VARIABLES(UInt8)
NO_VARIABLES(Int16)
NO_VARIABLES(UInt16)
NO_VARIABLES(Int32)
NO_VARIABLES(UInt32)
NO_VARIABLES(Int64)
NO_VARIABLES(UInt64)
NO_VARIABLES(Boolean)
NO_VARIABLES(String)

EXPORT fmi3Status fmi3GetFMUState(fmi3Instance c, fmi3FMUState *state) {
  return status(c && copy_state(c, (Stored **)state));
}
EXPORT fmi3Status fmi3SetFMUState(fmi3Instance c, fmi3FMUState state) { return status(c && set_state(c, state)); }
EXPORT fmi3Status fmi3FreeFMUState(fmi3Instance c, fmi3FMUState *state) {
  if (!c) return fmi3Error;
  free_stored((Stored **)state);
  return fmi3OK;
}
EXPORT fmi3Status fmi3SerializedFMUStateSize(fmi3Instance c, fmi3FMUState state, size_t *size) {
  if (!c || !state || !size) return fmi3Error;
  *size = stored_size(c);
  return fmi3OK;
}
EXPORT fmi3Status fmi3SerializeFMUState(fmi3Instance c, fmi3FMUState state, fmi3Byte bytes[], size_t size) {
  return status(c && write_state(c, state, bytes, size));
}
EXPORT fmi3Status fmi3DeserializeFMUState(fmi3Instance c, const fmi3Byte bytes[], size_t size, fmi3FMUState *state) {
  return status(c && read_state(c, bytes, size, (Stored **)state));
}

EXPORT fmi3Status fmi3DoStep(fmi3Instance c, fmi3Float64 point, fmi3Float64 length, fmi3Boolean keeps_no_state,
                             fmi3Boolean *needs_events, fmi3Boolean *terminates, fmi3Boolean *early,
                             fmi3Float64 *reached) {
  (void)keeps_no_state;
  if (!c) return fmi3Error;
  int accepted = advance_instance(c, point, length);
  if (needs_events) *needs_events = false;
  if (terminates) *terminates = false;
  if (early) *early = false;
  if (reached) *reached = ((Instance *)c)->state.time[0];
  return status(accepted);
}

/* Not offered: FMI 3.0 asks for the functions all the same. */
#define UNUSED(name, ...) \
  EXPORT fmi3Status fmi3##name(fmi3Instance c, __VA_ARGS__) { return missing(c, "fmi3" #name); }
#define UNUSED_MODE(name) \
  EXPORT fmi3Status fmi3##name(fmi3Instance c) { return missing(c, "fmi3" #name); }
#define REFERENCES const fmi3ValueReference r[], size_t n

#if defined(__clang__) || defined(__GNUC__)
#pragma GCC diagnostic ignored "-Wunused-parameter"
#endif
UNUSED_MODE(EnterEventMode)
UNUSED_MODE(EnterConfigurationMode)
UNUSED_MODE(ExitConfigurationMode)
UNUSED_MODE(EvaluateDiscreteStates)
UNUSED_MODE(EnterContinuousTimeMode)
UNUSED_MODE(EnterStepMode)
UNUSED(GetBinary, REFERENCES, size_t sizes[], fmi3Binary values[], size_t size)
UNUSED(SetBinary, REFERENCES, const size_t sizes[], const fmi3Binary values[], size_t size)
UNUSED(GetClock, REFERENCES, fmi3Clock values[])
UNUSED(SetClock, REFERENCES, const fmi3Clock values[])
UNUSED(GetNumberOfVariableDependencies, fmi3ValueReference r, size_t *count)
UNUSED(GetVariableDependencies, fmi3ValueReference r, size_t elements[], fmi3ValueReference independents[],
       size_t independent_elements[], fmi3DependencyKind kinds[], size_t count)
UNUSED(GetDirectionalDerivative, REFERENCES, const fmi3ValueReference knowns[], size_t known, const fmi3Float64 seed[],
       size_t seeds, fmi3Float64 sensitivity[], size_t sensitivities)
UNUSED(GetAdjointDerivative, REFERENCES, const fmi3ValueReference knowns[], size_t known, const fmi3Float64 seed[],
       size_t seeds, fmi3Float64 sensitivity[], size_t sensitivities)
UNUSED(GetIntervalDecimal, REFERENCES, fmi3Float64 intervals[], fmi3IntervalQualifier qualifiers[])
UNUSED(GetIntervalFraction, REFERENCES, fmi3UInt64 counters[], fmi3UInt64 resolutions[],
       fmi3IntervalQualifier qualifiers[])
UNUSED(GetShiftDecimal, REFERENCES, fmi3Float64 shifts[])
UNUSED(GetShiftFraction, REFERENCES, fmi3UInt64 counters[], fmi3UInt64 resolutions[])
UNUSED(SetIntervalDecimal, REFERENCES, const fmi3Float64 intervals[])
UNUSED(SetIntervalFraction, REFERENCES, const fmi3UInt64 counters[], const fmi3UInt64 resolutions[])
UNUSED(SetShiftDecimal, REFERENCES, const fmi3Float64 shifts[])
UNUSED(SetShiftFraction, REFERENCES, const fmi3UInt64 counters[], const fmi3UInt64 resolutions[])
UNUSED(UpdateDiscreteStates, fmi3Boolean *update, fmi3Boolean *terminates, fmi3Boolean *nominals, fmi3Boolean *values,
       fmi3Boolean *has_next, fmi3Float64 *next)
UNUSED(CompletedIntegratorStep, fmi3Boolean keeps_no_state, fmi3Boolean *event, fmi3Boolean *terminates)
UNUSED(SetTime, fmi3Float64 time)
UNUSED(SetContinuousStates, const fmi3Float64 states[], size_t count)
UNUSED(GetContinuousStateDerivatives, fmi3Float64 derivatives[], size_t count)
UNUSED(GetEventIndicators, fmi3Float64 indicators[], size_t count)
UNUSED(GetContinuousStates, fmi3Float64 states[], size_t count)
UNUSED(GetNominalsOfContinuousStates, fmi3Float64 nominals[], size_t count)
UNUSED(GetNumberOfEventIndicators, size_t *count)
UNUSED(GetNumberOfContinuousStates, size_t *count)
UNUSED(GetOutputDerivatives, REFERENCES, const fmi3Int32 orders[], fmi3Float64 values[], size_t size)
UNUSED(ActivateModelPartition, fmi3ValueReference clock, fmi3Float64 time)

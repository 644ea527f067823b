/* Layout of every record that Python and C share: the ONE table, read by C here and by `vehicle/core/records.py`.
 *
 * A record is a list of F(kind, name). Kinds are double, int64_t, the arrays below, and records of this table. A kind
 * has the same size on all platforms, wasm32 too: addresses take 8 bytes. `core_layout` (layout.c) returns the sizes
 * and offsets that the compiler chose; records.py compares them with its own. The meaning of each field of the march
 * stands here; that of the MuJoCo records in the classes of the same names in `vehicle/engines/simulation`.
 *
 * Add a record: its list here, a line in EACH_RECORD, and `records.packed("Name", object)` in Python. */
#ifndef CORE_LAYOUT_H
#define CORE_LAYOUT_H
#include <stdint.h>

#ifndef REAL
#define REAL double /* number type of the march: double or float, see vector.h */
#endif

/* Arrays in C order: address of the first number, numbers of rows, columns, ... Others than those of numbers hold records;
 * `Lanes` has rows of one 32-byte vector, aligned; `Reals` numbers of the type of the march. */
#define ARRAY(name, type, dimensions) \
  typedef struct { _Alignas(8) type *at; int64_t n[dimensions]; } name;
#define EACH_ARRAY(A) \
  A(Vector, double, 1) A(Table, double, 2) A(Tables3, double, 3) A(Index, int64_t, 1) A(Indices, int64_t, 2) \
  A(Words, uint32_t, 1) A(Texts, char, 2) A(Records, DamperLaw, 1) A(RecordTable, DamperLaw, 2) \
  A(Settings, Setting, 1) A(OwnLaws, OwnLaw, 1) A(Lanes, void, 1) A(Reals, REAL, 2)

/* ---- laws, see laws.h ---- */

/* Damper. viscous_damping: D [N s/m], the smallest slope of the curve; smoothing: eps [s/m]; friction_limit: Fd [N];
 * static_limit: Fs [N]; stribeck_velocity: vs [m/s]; stribeck_exponent: delta [-]; rest_force: F_c(0) - F_gas [N];
 * shift: shift - F_gas [N]; friction_law: index in FRICTION_LAWS, or an address (laws.h); side_force: growth of the limit with it [-]. */
#define DAMPER_LAW_FIELDS(F) \
  F(double, viscous_damping) F(double, smoothing) F(double, friction_limit) F(double, static_limit) \
  F(double, stribeck_velocity) F(double, stribeck_exponent) F(double, rest_force) F(double, shift) \
  F(double, friction_law) F(double, side_force)

/* Controlled damper at a time step. softest, firmest: cmin, cmax [N s/m]; sky: F over vb [N s/m], for an on-off law the
 * share of the range [-]; ground: -F over vw, likewise; on_off: 1 for an on-off law; period: steps between two readings;
 * lag: steps from reading to setting; change: largest change of c in a step [N s/m]; controller: address of a Call, or
 * 0. */
#define SETTING_FIELDS(F) \
  F(double, softest) F(double, firmest) F(double, sky) F(double, ground) F(double, on_off) F(double, period) \
  F(double, lag) F(double, change) F(double, controller)

/* A law by address: double function(void *memory, double first, double second). */
#define CALL_FIELDS(F) F(int64_t, function) F(int64_t, memory)

/* Force of a damper by address: double function(void *memory, double x, double v), in place of its curve.
 * viscous: D [N s/m], its slope at rest, which is in the linear system; timestep: h [s] of the march. */
#define OWN_LAW_FIELDS(F) F(int64_t, function) F(int64_t, memory) F(double, viscous) F(double, timestep)

/* Controller FMU, see controller.c. call: its step, with the address of this record; then addresses of its functions and
 * instance; status of the last call; finished readings; period: T [s]; coefficient: c [N s/m]; measured: values of the five sensors; sources: index among these of
 * each input; inputs: values of the inputs; references: value references of inputs and, last, output; results: four
 * words that a step writes. */
#define CONTROLLER_FIELDS(F) \
  F(Call, call) F(int64_t, set) F(int64_t, step) F(int64_t, get) F(int64_t, instance) F(int64_t, status) F(int64_t, readings) \
  F(double, period) F(double, coefficient) F(Vector, measured) F(Index, sources) F(Vector, inputs) \
  F(Words, references) F(Index, results)

/* ---- march of the reduced car, see march.c ---- */

/* Numbers and first rows of the sections of the table of a group; `vehicle.engines.reduced.table_layout.TableRows`. */
#define SECTIONS_FIELDS(F) \
  F(int64_t, pairs) F(int64_t, states) F(int64_t, iterations) F(int64_t, groups) F(int64_t, elements) F(int64_t, curves) \
  F(int64_t, corners) F(int64_t, rubbers) F(int64_t, layers) F(int64_t, slip) F(int64_t, level) F(int64_t, gain) \
  F(int64_t, ramp) F(int64_t, law) F(int64_t, pieces) F(int64_t, limit) F(int64_t, full) F(int64_t, inputs) \
  F(int64_t, viscous) F(int64_t, velocity) F(int64_t, earlier) F(int64_t, hold) F(int64_t, stuck) \
  F(int64_t, stick) F(int64_t, inverse) F(int64_t, sensors) F(int64_t, past) F(int64_t, direct) F(int64_t, spring) F(int64_t, give) \
  F(int64_t, share) F(int64_t, slider) F(int64_t, place) F(int64_t, rest) F(int64_t, corner) F(int64_t, own) \
  F(int64_t, excess) F(int64_t, heard) F(int64_t, stiff) F(int64_t, stroke) F(int64_t, part) F(int64_t, weight) \
  F(int64_t, reach) F(int64_t, anchor) F(int64_t, middle) F(int64_t, ahead) F(int64_t, work)

/* The march of a group over a block.
 * inputs: numbers of a step: forces, their slopes, forces of scalar elements, z', mean z', slope forces, z.
 * sums: damper velocities, displacements of scalar elements, then sensors. plates: driven plates. every: steps between
 * samples. tyres: driven plates whose loads act on the slope. plate_inputs: plates whose z is an input. step: index of
 * the next step. first: index of the first sample. loads: levels that are tyre loads; watched: levels whose extremes
 * are kept; check_every: samples between two checks; always: levels at every sample.
 * table, poles: numbers of the cars, see table_layout and step_factors. x: states of the previous sample and of a block
 * of samples. changes: changes of the poles from sample to sample, or empty. y: outputs of past samples and of a block.
 * peaks: squares of rotations, minimum and maximum of the watched levels. owners: damper of each group; pieces:
 * number of segments of each damper law, the others have no length; sides: dampers with a side force; laws: of dampers
 * with a friction limit that varies, or empty; controlled, settings, memory, outside: controlled dampers, and what acts
 * on them beside their law: its share [-], a coefficient [N s/m], half of a force [N]; own, own_laws: dampers with a law
 * by address. rates: z' at the beginning, mean z', z, V tan(beta) - z' of each step; plate_z: z of the samples
 * and their differences. positions, levels, rotations: weights of outputs in tiles; tyre_of: level of the tyre of each
 * law; wanted: row of each channel; offset: static values (channels, lanes); weights: of the second difference; cars:
 * row of each lane in out, (channels, cars, samples). */
#define MARCH_FIELDS(F) \
  F(Sections, rows) F(int64_t, inputs) F(int64_t, sums) F(int64_t, plates) F(int64_t, every) \
  F(int64_t, tyres) F(int64_t, plate_inputs) F(int64_t, step) F(int64_t, first) F(int64_t, loads) \
  F(int64_t, watched) F(int64_t, check_every) F(int64_t, always) F(int64_t, dampers) F(Lanes, table) \
  F(Lanes, poles) F(Lanes, x) F(Lanes, changes) F(Lanes, y) F(Lanes, peaks) F(Index, owners) F(Index, pieces) \
  F(Index, sides) F(RecordTable, laws) F(Index, controlled) F(Settings, settings) F(Table, memory) F(Table, outside) \
  F(Index, own) F(OwnLaws, own_laws) F(Reals, rates) \
  F(Reals, plate_z) F(Lanes, positions) F(Lanes, levels) F(Lanes, rotations) F(Index, tyre_of) F(Index, wanted) \
  F(Table, offset) F(Reals, weights) F(Index, cars) F(Tables3, out)

/* A car without Python, in an FMU or a page; `vehicle.runs.fmu.car_numbers`. march: its tables, without the memory of a
 * run. step: h [s]. dampers: laws; inner: first and last node of each law that matter while its curve is that of the car;
 * parameters: first values of the tunable parameters (dampers, 6). start: states at
 * rest by z' of each plate; sensor_start: sensors by z' and z; law_start: displacements of the laws that are no rubber
 * friction, likewise; law_corners: their breakpoints and slope changes. rows: of outputs, then of watched quantities,
 * over states and z; by_force, by_slope, by_law: over damper forces, forces on slopes and forces of laws at the same
 * instant; fixed: static values; kinds: kind and damper of each output; limits: lowest and highest value of each
 * watched quantity; notices: what a value beyond means; names: of plates, then of dampers; forces: names of the applied
 * forces, which are plates of the march after those of the wheels: z' is the force. */
#define EMBEDDED_FIELDS(F) \
  F(March, march) F(double, step) F(Records, dampers) F(Indices, inner) F(Table, parameters) F(Lanes, start) \
  F(Table, sensor_start) \
  F(Table, law_start) F(Tables3, law_corners) F(Lanes, rows) F(Table, by_force) F(Table, by_slope) F(Table, by_law) \
  F(Vector, fixed) F(Indices, kinds) F(Table, limits) F(Texts, names) F(Texts, notices) \
  F(Texts, forces)

/* ---- rows of MuJoCo: `element_records`, `step_records` and `sampling` of vehicle/engines/simulation ---- */

#define SPARSE_ROWS_FIELDS(F) \
  F(Table, jacobian) F(Vector, values) F(Index, places) F(Index, own) F(Index, offsets) F(Index, addresses) \
  F(Index, replaced) F(int64_t, size)

#define TICKET_FIELDS(F) \
  F(int64_t, model) F(int64_t, rows) F(int64_t, row_count) F(int64_t, time) F(Index, efc) F(SparseRows, sparse)

#define FIELDS_FIELDS(F) \
  F(Vector, qpos) F(Vector, qvel) F(Table, xmat) F(Table, site_xpos) F(Table, site_xmat) F(Table, subtree_com) \
  F(Table, cdof) F(Vector, qfrc_applied) F(Vector, actuator_velocity) F(Vector, qfrc_passive) \
  F(Vector, qfrc_bias) F(Vector, qacc_warmstart) F(Vector, M)

#define BUSHINGS_FIELDS(F) \
  F(Indices, rows) F(Index, carriers) F(Table, stiffness) F(Table, damping) F(Table, branch_stiffness) \
  F(Table, branch_time) F(Table, further) F(Index, averaged) F(Index, one_sided) F(Index, oblique) \
  F(Table, directions)

#define RUBBER_FRICTION_FIELDS(F) \
  F(Index, elements) F(Index, axes) F(Vector, stiffness) F(Vector, limit)

#define ROTATIONS_FIELDS(F) \
  F(Indices, sites) F(Vector, stiffness) F(Indices, turning) F(Indices, nodes) F(Table, shapes)

#define SPRINGS_FIELDS(F) \
  F(Index, rows) F(Vector, stiffness) F(Vector, lengths) F(Indices, sites) F(Table, shapes) F(Indices, dofs)

#define DAMPERS_FIELDS(F) \
  F(Records, laws) F(Index, rows) F(Index, frictions) F(Index, dofs) F(Index, places) F(Indices, valves) \
  F(Table, pieces)

#define PRESLIDING_FIELDS(F) \
  F(Index, rows) F(Index, dampers) F(Vector, stiffness) F(Vector, share)

#define SIDE_FORCES_FIELDS(F) \
  F(Index, dampers) F(Index, elements) F(Vector, signs) F(Index, oblique)

#define CONTROLS_FIELDS(F) \
  F(Index, dampers) F(Settings, laws) F(Indices, sites) F(Table, shapes) F(Indices, dofs)

#define OWN_DAMPERS_FIELDS(F) F(Index, dampers) F(OwnLaws, laws)

#define TABLES_FIELDS(F) \
  F(Index, kinds) F(Index, elements) F(Index, axes) F(Vector, at) F(Table, edges) F(Table, slopes) \
  F(Table, offsets)

#define MODES_FIELDS(F) \
  F(int64_t, body) F(int64_t, size) F(int64_t, first_velocity) F(int64_t, first_position) F(Index, turns) \
  F(Indices, rows) F(Table, node_shapes) F(Table, mode_shapes)

#define MODAL_SPACE_FIELDS(F) \
  F(Vector, mass) F(Vector, stiffness) F(Vector, damping) F(Vector, rest) F(Table, spread)

#define ROLLING_FIELDS(F) \
  F(Index, tyres) F(Index, plates) F(Index, sites) F(Index, hubs) F(Index, spins) F(Table, arms) \
  F(Vector, speeds) F(Vector, trails) F(Vector, inertias) F(Indices, dofs) F(Index, course) F(Vector, rest) \
  F(Vector, hold)

#define ROUND_TYRES_FIELDS(F) \
  F(Index, tyres) F(Index, hubs) F(Vector, radii) F(Indices, dofs)

#define APPLIED_FIELDS(F) \
  F(Index, sites) F(Table, directions) F(Index, frames) F(Index, forces) F(Indices, dofs) F(Index, nodes) \
  F(Table, shapes) F(Indices, torques) F(Vector, means)

#define FLUIDS_FIELDS(F) \
  F(Index, elements) F(Index, dofs) F(Index, places) F(Vector, factors)

#define LAYOUT_FIELDS(F) \
  F(Bushings, bushings) F(RubberFriction, rubber) F(Rotations, rotations) F(Springs, springs) \
  F(Dampers, dampers) F(Presliding, presliding) F(SideForces, sides) F(Controls, controls) F(OwnDampers, own) F(Tables, tables) \
  F(Modes, modes) F(ModalSpace, space) F(Rolling, rolling) F(RoundTyres, round) F(Fluids, fluids) \
  F(Applied, applied) F(Indices, joints) F(Index, tyres) F(Indices, reach) F(int64_t, row_count) F(int64_t, velocity_count)

#define WEIGHTS_FIELDS(F) \
  F(double, timestep) F(Vector, preload) F(Table, decay) F(Table, gain) F(Table, slope) F(Table, average) \
  F(Table, impedance) F(Table, inertial) F(Vector, spring_impedance) F(Vector, damper_impedance) \
  F(Vector, valve_impedance)

#define STATE_FIELDS(F) \
  F(Table, plate_velocity) F(Table, plate_acceleration) F(Vector, slope_velocity) F(Table, branch_past) \
  F(Table, branch_force) F(Table, last_rate) F(Vector, last_time) F(Table, residual) F(Table, rate) \
  F(Vector, explicit) F(Table, force) F(Table, torque) F(Table, frame) F(Table, ends) F(Table, line) \
  F(Vector, stretch) F(Table, deflection) F(Table, modal) F(Vector, modal_force) F(Vector, modal_rate) \
  F(Vector, modal_pull) F(Table, heading) F(Table, turning) F(Table, slope) F(Vector, push) F(Table, contact) \
  F(Table, rubber) F(Table, slider) F(Vector, stroke) F(Vector, limit) F(Vector, coefficient) F(Table, sensed) \
  F(Table, past) F(Vector, steps) F(Table, speeds) F(Vector, applied)

#define SOLUTION_FIELDS(F) \
  F(int64_t, size) F(Indices, inertia) F(Indices, groups) F(Index, columns) F(Indices, singles) \
  F(Indices, frictions) F(Index, starts) F(Index, tiles) F(Table, matrix) F(Vector, right) \
  F(Vector, acceleration) F(Vector, weight) F(Vector, limited)

#define SIMULATION_FIELDS(F) \
  F(Ticket, ticket) F(Fields, fields) F(Layout, layout) F(Weights, weights) F(State, state) \
  F(Solution, solution)

#define ORDER_FIELDS(F) \
  F(int64_t, step) F(int64_t, model) F(int64_t, data) F(int64_t, force_offset) F(int64_t, every) \
  F(int64_t, pose_every) F(int64_t, body) F(int64_t, first_velocity) F(double, half)

#define PLATES_FIELDS(F) \
  F(Table, height) F(Table, velocity) F(Table, acceleration) F(Table, slope) F(Table, tread) \
  F(Table, tread_change) F(Index, mocap) \
  F(Table, mocap_position) F(Table, row_velocity) F(Table, row_acceleration) F(Vector, row_slope) \
  F(Table, force) F(Vector, applied)

#define SOURCES_FIELDS(F) \
  F(Vector, position) F(Vector, velocity) F(Vector, acceleration) F(Table, orientation) \
  F(Table, site_positions) F(Vector, coefficient) F(Vector, actuator) F(Vector, explicit) F(Table, rate) \
  F(Table, branch) F(Table, modal) F(Vector, modal_force) F(Index, sites) F(Index, dampers) F(Table, origins) \
  F(Index, spring_rates) F(Index, load_bodies) F(Indices, load_springs) F(Table, contact) F(Table, rubber) \
  F(Table, heading) F(Vector, push) F(ModalSpace, space)

#define SAMPLES_FIELDS(F) \
  F(Table, places) F(Table, turn) F(Table, modal_position) F(Table, modal_velocity) F(Vector, modal_pull) \
  F(Table, damper_velocity) F(Table, coefficient) F(Table, actuator) F(Table, solved) F(Table, explicit) \
  F(Tables3, rate) F(Tables3, branch) F(Table, poses) F(Table, spring_rates) F(Table, load_frames) \
  F(Table, load_springs) F(Table, contact) F(Table, rubber) F(Table, heading) F(Vector, pushed)

#define LOOP_FIELDS(F) \
  F(Order, order) F(Plates, plates) F(Sources, sources) F(Samples, samples)

/* Damper behind a series stiffness under a measured motion, see damper_rig.c. rates: a_0, a_1, a_2 of each sample; knots:
 * n breakpoints; slopes, offsets: of the n + 1 segments around them; stiffness, limit, forces: of the elements; spring,
 * gas, offset: K, k_g [N/m], F_0 [N]; drop: friction at rest minus sliding [N]; critical: vs [m/s]; first: F [N].
 * Written: deflection s [m], inner w [m/s], and 1 in sticking where an element sticks. */
#define DAMPER_RIG_FIELDS(F) \
  F(Vector, displacement) F(Vector, velocity) F(Table, rates) F(Vector, knots) F(Vector, slopes) F(Vector, offsets) \
  F(Vector, stiffness) F(Vector, limit) F(Vector, forces) F(double, spring) F(double, gas) F(double, offset) \
  F(double, drop) F(double, critical) F(double, half) F(double, first) F(Vector, deflection) F(Vector, inner) F(Texts, sticking)

/* All records, each after those that it contains; arrays stand between the laws and the others. */
#define EACH_LAW(S) \
  S(DamperLaw, DAMPER_LAW_FIELDS) S(Setting, SETTING_FIELDS) S(Call, CALL_FIELDS) S(OwnLaw, OWN_LAW_FIELDS)
#define EACH_RECORD(S) \
  S(Controller, CONTROLLER_FIELDS) S(Sections, SECTIONS_FIELDS) S(March, MARCH_FIELDS) \
  S(Embedded, EMBEDDED_FIELDS) S(SparseRows, SPARSE_ROWS_FIELDS) S(Ticket, TICKET_FIELDS) S(Fields, FIELDS_FIELDS) \
  S(Bushings, BUSHINGS_FIELDS) S(RubberFriction, RUBBER_FRICTION_FIELDS) S(Rotations, ROTATIONS_FIELDS) \
  S(Springs, SPRINGS_FIELDS) S(Dampers, DAMPERS_FIELDS) S(Presliding, PRESLIDING_FIELDS) \
  S(SideForces, SIDE_FORCES_FIELDS) S(Controls, CONTROLS_FIELDS) S(OwnDampers, OWN_DAMPERS_FIELDS) \
  S(Tables, TABLES_FIELDS) \
  S(Modes, MODES_FIELDS) S(ModalSpace, MODAL_SPACE_FIELDS) S(Rolling, ROLLING_FIELDS) \
  S(RoundTyres, ROUND_TYRES_FIELDS) S(Fluids, FLUIDS_FIELDS) S(Applied, APPLIED_FIELDS) \
  S(Layout, LAYOUT_FIELDS) \
  S(Weights, WEIGHTS_FIELDS) S(State, STATE_FIELDS) S(Solution, SOLUTION_FIELDS) \
  S(Simulation, SIMULATION_FIELDS) S(Order, ORDER_FIELDS) S(Plates, PLATES_FIELDS) S(Sources, SOURCES_FIELDS) \
  S(Samples, SAMPLES_FIELDS) S(Loop, LOOP_FIELDS) S(DamperRig, DAMPER_RIG_FIELDS)

#define FIELD(kind, name) kind name;
#define RECORD(name, fields) typedef struct { fields(FIELD) } name;
EACH_LAW(RECORD)
EACH_ARRAY(ARRAY)
EACH_RECORD(RECORD)

#ifdef EMBEDDED
#define EXPORT /* in another library, whose functions alone are seen */
#else
#define EXPORT __attribute__((visibility("default")))
#endif
#endif

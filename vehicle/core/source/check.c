/* Lengths and indices of the records, checked before the core uses them: it reads and writes without any checks, so a
 * wrong length would be a crash or wrong numbers in the place of an exception. A function returns the name of the first
 * field that does not fit, or NULL. Addresses, and which numbers are finite, are not checked. */
#include <stddef.h>
#include "march.h"

#define NEED(name, condition) do { if (!(condition)) return name; } while (0)

static int within(const Index *indices, int64_t low, int64_t end) {
  for (int64_t i = 0; i < indices->n[0]; i++)
    if (indices->at[i] < low || indices->at[i] >= end) return 0;
  return 1;
}

/* One column of a table of indices. */
static int column_within(const Indices *indices, int64_t column, int64_t end) {
  for (int64_t i = 0; i < indices->n[0]; i++) {
    const int64_t value = indices->at[i * indices->n[1] + column];
    if (value < 0 || value >= end) return 0;
  }
  return 1;
}

/* Sections of the table: each from its first row on with its number of rows. */
static const char *check_sections(const March *job) {
  const Sections *r = &job->rows;
  const int64_t d = job->dampers, m = job->plates, g = r->groups + r->curves, solved = d + g, nodes = r->pieces + 1;
  const int64_t sensors = job->sums - solved, each = r->groups * r->elements, layers = r->rubbers * r->layers;
#define SECTION(name, size) NEED("rows." #name, r->name >= 0 && (size) >= 0 && r->name + (size) <= job->table.n[0])
  SECTION(slip, solved * m);
  SECTION(level, g * m);
  SECTION(gain, solved * solved);
  SECTION(ramp, solved * d);
  SECTION(law, 3 * d * nodes);
  SECTION(inputs, job->inputs);
  SECTION(limit, d);
  SECTION(full, d);
  SECTION(viscous, d);
  SECTION(velocity, d);
  SECTION(earlier, d);
  SECTION(hold, d);
  SECTION(stuck, d);
  SECTION(stick, d);
  SECTION(inverse, 2 * d);
  SECTION(sensors, sensors);
  SECTION(past, sensors);
  SECTION(direct, sensors * (2 * (d + m) + g));
  SECTION(heard, sensors * r->curves);
  SECTION(place, r->groups);
  SECTION(rest, 2 * job->sides.n[0]);
  SECTION(spring, each);
  SECTION(give, each);
  SECTION(share, each);
  SECTION(slider, each);
  SECTION(corner, 3 * (r->curves - r->rubbers) * r->corners);
  SECTION(own, r->curves);
  SECTION(excess, r->curves);
  SECTION(stiff, layers);
  SECTION(stroke, layers);
  SECTION(part, layers);
  SECTION(weight, layers);
  SECTION(reach, layers);
  SECTION(anchor, layers);
  SECTION(middle, layers);
  SECTION(ahead, r->rubbers);
  SECTION(work, d * (2 + 4 * nodes) + r->groups * (2 + 4 * r->elements) + job->sums);
  return NULL;
}

/* A march; `lanes`: cars in a vector, 1 in double and 8 in single precision. */
EXPORT const char *core_check_march(const March *job, int64_t lanes) {
  const Sections *r = &job->rows;
  const int64_t d = job->dampers, m = job->plates, block = 8, columns = lanes == 1 ? 4 : lanes;
  const int64_t *counts[] = {&job->dampers, &job->plates, &r->pairs, &r->groups, &r->elements, &r->curves, &r->corners,
                             &r->rubbers, &r->layers, &r->pieces, &job->tyres, &job->plate_inputs, &job->step,
                             &job->loads, &job->watched};
  for (size_t i = 0; i < sizeof counts / sizeof *counts; i++) NEED("counts", *counts[i] >= 0);
  NEED("every", job->every > 0);
  NEED("check_every", job->check_every > 0);
  NEED("rows.iterations", r->iterations > 0);
  NEED("rows.states", r->pairs % block == 0 && r->states >= r->pairs);
  NEED("rows.rubbers", r->rubbers <= r->curves);
  NEED("tyres", job->tyres <= m);
  NEED("plate_inputs", job->plate_inputs <= m);
  NEED("inputs", job->inputs >= force_count(job) + 2 * m + job->tyres + job->plate_inputs);
  const int64_t nodes = r->pieces + 1, own = job->own.n[0], sides = job->sides.n[0], controlled = job->controlled.n[0];
  NEED("sums", job->sums >= solved_count(job) + job->tyres + 2 * (controlled + sides) + own);
  const char *wrong = check_sections(job);
  if (wrong) return wrong;
  const int64_t blocks = r->pairs / block + (r->states - r->pairs + block - 1) / block, states = state_count(job);
  NEED("poles", job->poles.n[0] >= blocks * block * (1 + job->inputs + job->sums));
  NEED("x", job->x.n[0] >= (INNER + 1) * states + block);
  NEED("changes", job->changes.n[0] == 0 || job->changes.n[0] >= (INNER + 1) * r->states + block);
  const int64_t weights = (states + m) * TILE;
  NEED("positions", job->positions.n[0] % weights == 0);
  NEED("levels", job->levels.n[0] % weights == 0);
  NEED("rotations", job->rotations.n[0] % weights == 0);
  const SampleRows s = sample_rows(job);
  NEED("y", job->y.n[0] >= (PAST + INNER) * s.width);
  NEED("loads", job->loads <= job->watched);
  NEED("watched", s.levels + job->watched <= s.speeds);
  NEED("peaks", job->peaks.n[0] >= job->rotations.n[0] / weights + 2 * job->watched);
  NEED("owners", job->owners.n[0] >= r->groups && within(&job->owners, 0, d));
  NEED("pieces", job->pieces.n[0] == d && within(&job->pieces, 0, nodes));
  NEED("sides", within(&job->sides, 0, d));
  NEED("controlled", within(&job->controlled, 0, d));
  NEED("own", within(&job->own, 0, d));
  NEED("own_laws", job->own_laws.n[0] == own);
  for (int64_t k = 0; k < own; k++) NEED("own_laws", job->own_laws.at[k].function != 0);
  NEED("laws", job->laws.n[0] == 0 || job->laws.n[0] == d);
  NEED("laws", job->laws.n[0] ? job->laws.n[1] == lanes : sides == 0);
  NEED("settings", job->settings.n[0] == controlled);
  NEED("memory", job->memory.n[0] == controlled);
  NEED("outside", job->outside.n[0] == controlled && job->outside.n[1] == 3);
  for (int64_t k = 0; k < controlled; k++) {
    NEED("settings", job->settings.at[k].period >= 1.0 && job->settings.at[k].lag >= 0.0);
    NEED("memory", (double)job->memory.n[1] >= RING + job->settings.at[k].lag + 1.0);
  }
  const int64_t samples = job->plate_z.n[0], channels = job->out.n[0];
  NEED("plate_z", job->plate_z.n[1] == 2 * m);
  NEED("rates", job->rates.n[0] > samples * job->every && job->rates.n[1] == 4 * m);
  NEED("tyre_of", job->tyre_of.n[0] >= r->curves && within(&job->tyre_of, -1, s.speeds - s.levels));
  NEED("wanted", job->wanted.n[0] <= channels && within(&job->wanted, -1, s.width));
  NEED("offset", job->offset.n[0] >= job->wanted.n[0] && job->offset.n[1] == columns);
  NEED("weights", job->weights.n[0] * job->weights.n[1] >= PAST);
  NEED("cars", job->cars.n[0] <= lanes && within(&job->cars, 0, job->out.n[1]));
  return NULL;
}

/* Records of the rows of MuJoCo; `positions`, `bodies`, `sites`: those of the model. */
EXPORT const char *core_check_simulation(const Simulation *s, int64_t positions, int64_t bodies, int64_t sites) {
  const Layout *e = &s->layout;
  const int64_t rows = s->ticket.rows, speeds = e->velocity_count, dampers = e->dampers.dofs.n[0];
  const int64_t elements = e->bushings.rows.n[0], springs = e->springs.rows.n[0];
  NEED("row_count", e->row_count == rows && s->state.explicit.n[0] == rows && s->weights.preload.n[0] >= rows);
  NEED("fields", s->fields.qpos.n[0] == positions && s->fields.qvel.n[0] == speeds);
  NEED("bushings.rows", e->bushings.rows.n[1] == 3 && column_within(&e->bushings.rows, 2, rows));
  NEED("bushings.carriers", e->bushings.carriers.n[0] == elements && within(&e->bushings.carriers, 0, bodies));
  NEED("bushings.stiffness", e->bushings.stiffness.n[0] == elements && e->bushings.damping.n[0] == elements);
  NEED("bushings.one_sided", within(&e->bushings.one_sided, 0, elements));
  NEED("bushings.oblique", within(&e->bushings.oblique, 0, elements));
  NEED("bushings.directions", e->bushings.directions.n[0] == e->bushings.oblique.n[0]);
  NEED("rubber.elements", within(&e->rubber.elements, 0, elements) && within(&e->rubber.axes, 0, 3));
  NEED("rubber.limit", e->rubber.limit.n[0] == e->rubber.elements.n[0]);
  NEED("springs.rows", within(&e->springs.rows, 0, rows) && e->springs.stiffness.n[0] == springs);
  NEED("springs.sites", e->springs.sites.n[0] == springs && column_within(&e->springs.sites, 1, sites));
  NEED("springs.dofs", column_within(&e->springs.dofs, 0, springs) && column_within(&e->springs.dofs, 2, speeds));
  NEED("dampers.laws", e->dampers.laws.n[0] == dampers);
  NEED("dampers.rows", e->dampers.rows.n[0] == dampers && within(&e->dampers.rows, 0, rows));
  NEED("dampers.frictions", e->dampers.frictions.n[0] == dampers && within(&e->dampers.frictions, 0, rows));
  NEED("dampers.dofs", within(&e->dampers.dofs, 0, speeds));
  NEED("dampers.places", e->dampers.places.n[0] == dampers && within(&e->dampers.places, 0, positions));
  NEED("dampers.valves", column_within(&e->dampers.valves, 0, rows) && column_within(&e->dampers.valves, 1, dampers));
  NEED("dampers.pieces", e->dampers.pieces.n[0] == e->dampers.valves.n[0]);
  NEED("presliding.rows", within(&e->presliding.rows, 0, rows) && within(&e->presliding.dampers, 0, dampers));
  NEED("presliding.stiffness", e->presliding.stiffness.n[0] == e->presliding.rows.n[0]);
  NEED("sides.elements", within(&e->sides.dampers, 0, dampers) && within(&e->sides.elements, 0, elements));
  NEED("controls.dampers", within(&e->controls.dampers, 0, dampers));
  NEED("controls.laws", e->controls.laws.n[0] == e->controls.dampers.n[0]);
  NEED("past", s->state.past.n[0] == e->controls.dampers.n[0]);
  for (int64_t k = 0; k < e->controls.laws.n[0]; k++)
    NEED("past", (double)s->state.past.n[1] >= RING + e->controls.laws.at[k].lag + 1.0);
  NEED("own.dampers", within(&e->own.dampers, 0, dampers) && e->own.laws.n[0] == e->own.dampers.n[0]);
  const int64_t tables = e->tables.kinds.n[0]; /* of those that act; some may be left out */
  NEED("tables.elements", e->tables.elements.n[0] >= tables && within(&e->tables.kinds, 0, 4));
  NEED("tables.edges", e->tables.edges.n[0] >= tables && s->state.stretch.n[0] >= tables);
  NEED("tyres", within(&e->tyres, 0, elements) && s->state.plate_velocity.n[0] == e->tyres.n[0]);
  NEED("reach", e->reach.n[1] == 4 && column_within(&e->reach, 0, rows));
  NEED("joints", e->joints.n[0] == 0 || (e->joints.n[1] == 3 && column_within(&e->joints, 2, rows)));
  const Applied *a = &e->applied;
  const int64_t forces = s->state.applied.n[0], ends = a->sites.n[0];
  NEED("applied.means", a->means.n[0] == forces);
  NEED("applied.sites", within(&a->sites, 0, sites) && a->directions.n[0] == ends && a->forces.n[0] == ends);
  NEED("applied.forces", within(&a->forces, 0, forces) && column_within(&a->torques, 1, forces));
  NEED("applied.dofs", column_within(&a->dofs, 0, ends) && column_within(&a->dofs, 1, speeds));
  NEED("applied.dofs", column_within(&a->dofs, 2, bodies) && column_within(&a->torques, 0, speeds));
  NEED("applied.nodes", within(&a->nodes, 0, ends) && a->shapes.n[0] == a->nodes.n[0]);
  NEED("applied.shapes", a->shapes.n[0] == 0 || a->shapes.n[1] == 6 * e->modes.size);
  NEED("push", s->state.push.n[0] == (ends + a->torques.n[0] + e->rolling.tyres.n[0] > 0 ? speeds : 0));
  NEED("rolling.rest", e->rolling.rest.n[0] == (e->rolling.tyres.n[0] > 0 ? 2 + 3 * e->rolling.tyres.n[0] : 0));
  NEED("fluids.elements", within(&e->fluids.elements, 0, elements) && within(&e->fluids.dofs, 0, speeds));
  return NULL;
}

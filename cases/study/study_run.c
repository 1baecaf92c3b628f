#include "cases/study/study_run.h"

#include <glob.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cases/plan/design_statistics.h"
#include "cases/study/design_message.h"
#include "cases/study/nearest_design.h"
#include "cases/study/optimisation.h"
#include "cases/study/study_summary.h"
#include "mesh/base/memory.h"
#include "postproc/draw/text_buffer.h"
#include "postproc/study/study_csv.h"
#include "postproc/study/study_file.h"
#include "postproc/study/study_publish.h"

static const double PUBLISH_EVERY = 10; /* s */

typedef struct {
  const study_spec *spec;
  design_study     *study;
  shb_progress     *progress;
  char             *path;    /* NAME.study.h5 */
  int               next;    /* first design that was not looked at */
  bool              again;   /* designs that did not converge are tried again, from here on */
  double           *request; /* [2 n_keys] */
  int              *twin;    /* [n] an earlier design of the same digest, or -1 */
  bool             *given;   /* [n] handed out, or taken from a file */
  bool             *tried;   /* [n] handed out again, or the result of that was taken from a file */
  int               n_at_work, n_done, n_computed, n_to_compute;
  double            started, published;
  bool              changed; /* since the last publication */
  optimisation     *search;  /* NULL: the designs are known from the start */
} running;

char *study_path(const study_spec *spec, const char *suffix) {
  const bool here = strcmp(spec->folder, ".") == 0;
  return shb_text_of("%s%s%s%s", here ? "" : spec->folder, here ? "" : "/", spec->name, suffix);
}

/* ---------------------------------------------------------------- the study before any run */

static void name_columns(const study_spec *spec, design_study *s) {
  for (int k = 0; k < spec->keys.n; k++) {
    char name[STUDY_KEY_TEXT];
    study_key_name(&spec->keys.key[k], name);
    snprintf(s->key[k].name, STUDY_NAME, "%.*s", STUDY_NAME - 1, name);
    snprintf(s->key[k].unit, STUDY_UNIT, "%s", spec->keys.key[k].unit);
  }
  for (int i = 0; i < spec->n_outputs; i++) {
    snprintf(s->output[i].name, STUDY_NAME, "%s", spec->output[i].name);
    snprintf(s->output[i].unit, STUDY_UNIT, "%s", spec->output[i].unit);
  }
  for (int i = 0; i < s->n_derivatives; i++) {
    char name[STUDY_UNIT_TEXT], unit[STUDY_UNIT_TEXT];
    study_derivative(&spec->base, i, name, unit, &s->derivative[i].at);
    snprintf(s->derivative[i].name, STUDY_NAME, "%s", name);
    snprintf(s->derivative[i].unit, STUDY_UNIT, "%s", unit);
  }
}

static shb_status set_up(const study_spec *spec, design_study *s) {
  SHB_TRY(design_study_create(spec->keys.n, spec->n_outputs,
                              study_derivatives(spec->n_outputs, spec->output), s));
  s->name      = strdup(spec->name);
  s->text      = strdup(spec->text);
  s->path      = strdup(spec->path);
  s->case_path = strdup(spec->case_path);
  s->case_text = strdup(spec->base.text);
  study_plan_text(&spec->plan, &spec->keys, s->plan, sizeof s->plan);
  if (spec->optimise.wanted) snprintf(s->plan, sizeof s->plan, "optimise");
  name_columns(spec, s);
  bool good = s->name && s->text && s->path && s->case_path && s->case_text;
  for (int d = 0; d < spec->n_designs && good && !spec->optimise.wanted; d++) {
    study_design *one = design_study_add(s, spec->design + (size_t)d * (size_t)spec->keys.n);
    good              = one != NULL;
    if (one) snprintf(one->digest, STUDY_DIGEST, "%s", spec->digest[d]);
  }
  SHB_CHECK(good, SHB_ERR_IO, "no memory for %d designs", spec->n_designs);
  return SHB_OK;
}

/* ---------------------------------------------------------------- known results */

typedef struct {
  const char *digest;
  int         design;
} digest_place;

static int by_digest(const void *left, const void *right) {
  const digest_place *a = left, *b = right;
  int                 order = strcmp(a->digest, b->digest);
  return order ? order : (a->design > b->design) - (a->design < b->design);
}

/* The digests of a study, sorted, equal ones by rising design; malloc'ed. */
static digest_place *sorted(const design_study *s) {
  digest_place *list = shb_alloc((size_t)s->n + 1, sizeof *list);
  for (int i = 0; i < s->n; i++) list[i] = (digest_place){s->design[i].digest, i};
  qsort(list, (size_t)s->n, sizeof *list, by_digest);
  return list;
}

static shb_status find_twins(running *r) {
  digest_place *list = sorted(r->study);
  for (int i = 0; i < r->study->n; i++) {
    bool same               = i > 0 && strcmp(list[i].digest, list[i - 1].digest) == 0;
    int  first              = same ? list[i - 1].design : -1;
    r->twin[list[i].design] = same && r->twin[first] >= 0 ? r->twin[first] : first;
  }
  free(list);
  return SHB_OK;
}

/* The design of the same digest as another one of a known study; -1: there is none. */
static int same_design(const design_study *s, const design_study *known, int design) {
  for (int i = 0; design >= 0 && i < s->n; i++)
    if (strcmp(s->design[i].digest, known->design[design].digest) == 0) return i;
  return -1;
}

/* Whether the result of a known design holds here: not of one that was tried again from a design
 * that this study has not. Sets from whose peak it was tried again. */
static bool holds(const design_study *s, const design_study *known, const study_design *from,
                  int *tried_from) {
  *tried_from = same_design(s, known, from->tried_from);
  return from->state != STUDY_WAITING && from->state != STUDY_FAILED &&
         (from->tried_from < 0 || *tried_from >= 0);
}

/* Take over the results that another file has. A failure of a process is tried again. */
static shb_status take_known(running *r, const design_study *known) {
  design_study *s = r->study;
  if (known->n_outputs != s->n_outputs || known->n_derivatives != s->n_derivatives)
    return SHB_OK; /* other outputs, other digests */
  digest_place *list   = sorted(known);
  shb_status    status = SHB_OK;
  for (int i = 0; i < s->n && status == SHB_OK; i++) {
    const digest_place wanted = {s->design[i].digest, 0};
    size_t             low = 0, high = (size_t)known->n;
    while (low < high) { /* the first that is not before it */
      size_t middle = (low + high) / 2;
      if (by_digest(&list[middle], &wanted) < 0)
        low = middle + 1;
      else
        high = middle;
    }
    if (r->given[i] || low == (size_t)known->n || strcmp(list[low].digest, wanted.digest) != 0)
      continue;
    const study_design *from = &known->design[list[low].design];
    int                 tried_from;
    if (!holds(s, known, from, &tried_from)) continue;
    status               = design_message_copy(from, s->n_outputs, s->n_derivatives, &s->design[i]);
    r->given[i]          = true;
    s->design[i].seconds = from->seconds;
    s->design[i].tried_from = tried_from;
    r->n_done++;
  }
  free(list);
  return status;
}

/* This study's own file and all others beside it. Files that cannot be read hold nothing. */
static shb_status take_all_known(running *r) {
  char      *pattern = shb_text_of("%s/*.study.h5", r->spec->folder);
  glob_t     found   = {0};
  shb_status status  = SHB_OK;
  if (glob(pattern, 0, NULL, &found) != 0) found.gl_pathc = 0;
  for (size_t i = 0; i < found.gl_pathc && status == SHB_OK; i++) {
    design_study known;
    if (study_file_read(found.gl_pathv[i], &known) != SHB_OK) continue;
    if (r->search) {
      status = optimisation_know(r->search, &known);
      continue;
    }
    status = take_known(r, &known);
    design_study_free(&known);
  }
  globfree(&found);
  free(pattern);
  return status;
}

/* ---------------------------------------------------------------- while it runs */

static shb_status publish(running *r, bool finished) {
  post_buffer table  = {0};
  char       *csv    = study_path(r->spec, ".study.csv");
  r->study->finished = finished;
  shb_status status  = study_file_write(r->study, r->path);
  if (status == SHB_OK) {
    study_csv(r->study, &table);
    status = post_buffer_publish(&table, csv);
  }
  post_buffer_free(&table);
  free(csv);
  r->published = shb_seconds();
  r->changed   = false;
  return status;
}

/* The request for a design, from the peak of another one, or -1. */
static const double *request_for(running *r, const double *value, int from) {
  int           n      = r->spec->keys.n;
  const double *beside = from >= 0 ? r->study->design[from].key : NULL;
  for (int k = 0; k < n; k++) {
    r->request[k]     = value[k];
    r->request[n + k] = beside ? beside[k] : NAN;
  }
  return r->request;
}

/* After all others, designs that did not converge are tried again, each from the peak of the
 * nearest solved one. Those that are solved so help no others, so that the order does not count.
 * The result of a file stays where that design is the same. */
static int next_again(running *r) {
  design_study *s = r->study;
  if (!r->again) {
    if (r->n_at_work > 0) return -1;
    r->again = true;
    r->next  = 0;
  }
  for (; r->next < s->n; r->next++) {
    study_design *d    = &s->design[r->next];
    bool          open = d->state == STUDY_NOT_CONVERGED || d->tried_from >= 0;
    if (!open || r->tried[r->next]) continue;
    r->tried[r->next] = true;
    int from          = nearest_design(s, r->next);
    if (from < 0 || from == d->tried_from) continue;
    d->tried_from = from;
    r->n_to_compute++;
    return r->next++;
  }
  return -1;
}

static int next_design(void *context, const double **request) {
  running      *r = context;
  const double *value;
  int           design = -1;
  if (shb_interrupted()) return -1;
  if (r->search) {
    design = optimisation_next(r->search, &value);
    if (design >= 0) *request = request_for(r, value, -1);
    return design;
  }
  while (!r->again && r->next < r->study->n && (r->given[r->next] || r->twin[r->next] >= 0))
    r->next++;
  if (!r->again && r->next < r->study->n) {
    design           = r->next++;
    r->given[design] = true;
  } else {
    design = next_again(r);
  }
  if (design < 0) return -1;
  r->n_at_work++;
  const study_design *d = &r->study->design[design];
  *request              = request_for(r, d->key, r->again ? d->tried_from : -1);
  return design;
}

/* "2 min 5 s" */
static void put_time(double seconds, char out[32]) {
  int s = (int)(seconds + 0.5);
  if (s >= 3600) {
    snprintf(out, 32, "%d h %d min", s / 3600, s / 60 % 60);
  } else if (s >= 60) {
    snprintf(out, 32, "%d min %d s", s / 60, s % 60);
  } else {
    snprintf(out, 32, "%d s", s);
  }
}

static void show(running *r) {
  char   left[32] = "";
  double passed   = shb_seconds() - r->started;
  int    rest     = r->n_to_compute - r->n_computed;
  if (r->n_computed > 0) put_time(passed / r->n_computed * rest, left);
  int all = r->search ? r->n_to_compute : r->study->n;
  shb_progress_show(r->progress, 100. * r->n_done / all, "design %d of %d  %d failed  %s%s",
                    r->n_done, all, design_study_count(r->study, STUDY_FAILED), left,
                    left[0] ? " left" : "");
}

/* Say in the reason of a design that it was tried again, and from where. */
static void tell_trial(study_design *d) {
  static const char mark[] = "; tried again from the peak of design ";
  char              text[1024];
  const char       *reason = d->reason ? d->reason : "", *former = strstr(reason, mark);
  int               length = former ? (int)(former - reason) : (int)strlen(reason);
  if (d->state == STUDY_DONE)
    snprintf(text, sizeof text, "solved from the peak of design %d%s%s", d->tried_from + 1,
             reason[0] ? "; " : "", reason);
  else
    snprintf(text, sizeof text, "%.*s%s%d", length, reason, mark, d->tried_from + 1);
  study_design_set_reason(d, text);
}

/* Take the result of a design that was tried again. If that failed, the former one stays. */
static shb_status take_again(running *r, study_design *d, const char *bytes, size_t size) {
  design_study  one;
  int           outputs = r->study->n_outputs, derivatives = r->study->n_derivatives;
  double        seconds = d->seconds;
  shb_status    status  = design_study_create(r->study->n_keys, outputs, derivatives, &one);
  study_design *again   = status == SHB_OK ? design_study_add(&one, d->key) : NULL;
  if (status == SHB_OK && !again)
    status = shb_fail(SHB_ERR_IO, __FILE__, __LINE__, "out of memory");
  if (status == SHB_OK) status = design_message_unpack(bytes, size, outputs, derivatives, again);
  if (status == SHB_OK && again->state != STUDY_FAILED)
    status = design_message_unpack(bytes, size, outputs, derivatives, d);
  if (status == SHB_OK) {
    d->seconds = seconds + again->seconds;
    if (again->state == STUDY_FAILED) d->state = STUDY_NOT_CONVERGED;
    tell_trial(d);
  }
  design_study_free(&one);
  return status;
}

static shb_status done(void *context, int design, const char *bytes, size_t size) {
  running      *r = context;
  study_design *d = &r->study->design[design];
  r->n_at_work--;
  if (r->again) {
    SHB_TRY(take_again(r, d, bytes, size));
  } else {
    SHB_TRY(design_message_unpack(bytes, size, r->study->n_outputs, r->study->n_derivatives, d));
    r->n_done++;
  }
  if (r->search) optimisation_done(r->search, design);
  r->n_computed++;
  r->changed = true;
  show(r);
  return SHB_OK;
}

static shb_status tick(void *context) {
  running *r   = context;
  bool     due = r->changed && shb_seconds() - r->published > PUBLISH_EVERY;
  return due ? publish(r, false) : SHB_OK;
}

/* Give the twins the results of the designs that were computed. */
static shb_status copy_twins(running *r) {
  for (int i = 0; i < r->study->n; i++) {
    const study_design *from = r->twin[i] >= 0 ? &r->study->design[r->twin[i]] : NULL;
    if (r->given[i] || !from || from->state == STUDY_WAITING) continue;
    SHB_TRY(design_message_copy(from, r->study->n_outputs, r->study->n_derivatives,
                                &r->study->design[i]));
    r->study->design[i].tried_from = from->tried_from;
    r->n_done++;
  }
  return SHB_OK;
}

static int count_work(const running *r) {
  int n = 0;
  for (int i = 0; i < r->study->n; i++) n += !r->given[i] && r->twin[i] < 0;
  return n;
}

static shb_status put_statistics(running *r) {
  const study_spec    *spec    = r->spec;
  const design_samples samples = {
      spec->keys.n - spec->keys.n_uncertain, study_plan_group(&spec->plan, &spec->keys),
      study_plan_has_blocks(&spec->plan, &spec->keys), spec->plan.sample_seed};
  return spec->keys.n_uncertain > 0 ? design_statistics(&samples, r->study) : SHB_OK;
}

static shb_status run_all(running *r, bool force, const crew_staff *workers) {
  SHB_TRY(find_twins(r));
  if (!force) SHB_TRY(take_all_known(r));
  r->n_to_compute = count_work(r);
  shb_progress_note(r->progress, "%d designs, %d to compute, %d at a time", r->study->n,
                    r->n_to_compute, workers->n);
  r->started = r->published = shb_seconds();
  const crew_work work      = {r, next_design, done, tick};
  SHB_TRY(workers->manage(workers->context, &work));
  SHB_TRY(copy_twins(r));
  shb_progress_clear(r->progress);
  if (!shb_interrupted()) SHB_TRY(put_statistics(r));
  SHB_TRY(publish(r, !shb_interrupted()));
  return study_publish(r->study, r->path); /* the page */
}

/* An optimisation: the designs come from its search. */
static shb_status search(running *r, bool force, const crew_staff *workers) {
  const crew_work work   = {r, next_design, done, tick};
  shb_status      status = force ? SHB_OK : take_all_known(r);
  r->n_to_compute        = r->spec->optimise.evaluations;
  shb_progress_note(r->progress, "at most %d designs, %d at a time", r->n_to_compute, workers->n);
  r->started = r->published = shb_seconds();
  if (status == SHB_OK) status = workers->manage(workers->context, &work);
  shb_progress_clear(r->progress);
  if (status == SHB_OK) status = optimisation_finish(r->search);
  SHB_TRY(status);
  SHB_TRY(publish(r, !shb_interrupted()));
  return study_publish(r->study, r->path);
}

static shb_status search_all(running *r, bool force, const crew_staff *workers) {
  shb_status status = optimisation_create(r->spec, r->study, &r->search);
  if (status == SHB_OK) status = search(r, force, workers);
  optimisation_destroy(r->search);
  return status;
}

shb_status study_run(const study_spec *spec, bool force, const crew_staff *workers,
                     shb_progress *progress, design_study *s) {
  shb_status status = set_up(spec, s);
  running    r      = {.spec = spec, .study = s, .progress = progress};
  size_t     n      = (size_t)s->n + 1;
  r.path            = study_path(spec, ".study.h5");
  r.twin            = shb_alloc(n, sizeof *r.twin);
  r.given           = shb_alloc_zeroed(n, sizeof *r.given);
  r.tried           = shb_alloc_zeroed(n, sizeof *r.tried);
  r.request         = shb_alloc_zeroed(2 * (size_t)spec->keys.n + 1, sizeof *r.request);
  if (status == SHB_OK && spec->optimise.wanted)
    status = search_all(&r, force, workers);
  else if (status == SHB_OK)
    status = run_all(&r, force, workers);
  free(r.path);
  free(r.twin);
  free(r.given);
  free(r.tried);
  free(r.request);
  SHB_TRY(status);
  if (shb_interrupted())
    SHB_FAIL(SHB_INTERRUPTED, "interrupted; the same command goes on where it stopped");
  int failed = design_study_count(s, STUDY_FAILED),
      not    = design_study_count(s, STUDY_NOT_CONVERGED);
  SHB_CHECK(failed + not == 0, SHB_NOT_CONVERGED,
            "%d designs failed, %d did not converge; their rows say why", failed, not );
  return SHB_OK;
}

/* ---------------------------------------------------------------- what came out */

/* The design with the least (or largest) value of an output; -1: none has one. */
static int extreme(const design_study *s, int output, bool largest) {
  int best = -1;
  for (int i = 0; i < s->n; i++) {
    double value = s->design[i].value[output];
    if (!isfinite(value)) continue;
    if (best < 0 || (value > s->design[best].value[output]) == largest) best = i;
  }
  return best;
}

void study_run_summary(const study_spec *spec, const design_study *s, FILE *out) {
  char *h5 = study_path(spec, ".study.h5"), *csv = study_path(spec, ".study.csv");
  fprintf(out, "%s: %d designs, %d failed, %d not converged\n", s->name, s->n,
          design_study_count(s, STUDY_FAILED), design_study_count(s, STUDY_NOT_CONVERGED));
  for (int i = 0; i < s->n_outputs; i++) {
    int low = extreme(s, i, false), high = extreme(s, i, true);
    if (low < 0) continue;
    fprintf(out, "  %-20s %.6g to %.6g %s, designs %d and %d\n", s->output[i].name,
            s->design[low].value[i], s->design[high].value[i],
            strcmp(s->output[i].unit, "-") == 0 ? "" : s->output[i].unit, low + 1, high + 1);
  }
  study_summary_statistics(s, out);
  if (s->optimum.best >= 0) {
    fprintf(out, "  optimum   design %d", s->optimum.best + 1);
    for (int k = 0; k < s->n_keys; k++)
      fprintf(out, ", %s %.8g", s->key[k].name, s->design[s->optimum.best].key[k]);
    fprintf(out, "\n");
  }
  if (s->optimum.note) fprintf(out, "%s\n", s->optimum.note);
  fprintf(out, "table     %s\nstudy     %s\n", csv, h5);
  free(h5);
  free(csv);
}

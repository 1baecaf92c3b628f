#include "postproc/field/field_scene.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "mesh/base/vec3.h"
#include "postproc/draw/colour.h"
#include "postproc/field/blade_skin.h"

_Static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "glTF is little-endian");

enum { INSTANTS = 64, TARGETS = 2 * POST_SCENE_HARMONICS, SECONDS = 2 /* a period is shown */ };
enum { BYTE = 5121, UNSIGNED = 5125, FLOAT = 5126, VERTICES = 34962, INDICES = 34963 };

static const double SHOWN = 1e-3; /* of the largest harmonic */
static const double GREAT = 0.05; /* displacement in the picture, of the greatest dimension */

typedef struct {
  const post_period *period;
  post_skin          skin;
  double            *largest; /* [node] Pa */
  post_scene_note   *note;
  int                steps, copies;
  float             *values; /* scratch: [skin node][3], or the keys of an animation */
  post_buffer        binary, views, accessors, samplers, channels, nodes;
  int                n_accessors;
} scene;

/* ------------------------------------------------------------------ what is shown */

static double size_of_harmonic(const post_period *p, int k) {
  const size_t  n    = 3 * (size_t)p->field->n_nodes;
  const double *real = p->displacement + 2 * (size_t)k * n, *imaginary = real + n;
  double        most = 0;
  for (size_t i = 0; i < n; i += 3)
    most = fmax(most, hypot(vec3_norm(real + i), vec3_norm(imaginary + i)));
  return most;
}

/* The largest harmonics, ascending. */
static void choose_harmonics(const post_period *p, post_scene_note *note) {
  double size[p->n_harmonics + 1], most = 0;
  note->n_harmonics = 0;
  for (int k = 1; k <= p->n_harmonics; k++) most = fmax(most, size[k] = size_of_harmonic(p, k));
  for (int k = 1; k <= p->n_harmonics; k++) {
    int larger = 0;
    for (int i = 1; i <= p->n_harmonics; i++) larger += size[i] > size[k];
    if (larger < POST_SCENE_HARMONICS && size[k] > 0 && size[k] >= SHOWN * most &&
        note->n_harmonics < POST_SCENE_HARMONICS)
      note->harmonic[note->n_harmonics++] = k;
  }
}

static double greatest_dimension(const scene *s) {
  double most = 0;
  for (int d = 0; d < 3; d++) {
    double low = INFINITY, high = -INFINITY;
    for (int i = 0; i < s->skin.n_nodes; i++) {
      const double x = s->period->field->nodes[3 * s->skin.node[i] + d];
      low            = fmin(low, x);
      high           = fmax(high, x);
    }
    most = fmax(most, high - low);
  }
  return most;
}

static shb_status prepare(scene *s, double scale) {
  const post_period *p = s->period;
  const size_t       n = (size_t)p->field->n_nodes;
  SHB_TRY(post_skin_create(&p->field->mesh, &s->skin));
  const size_t keys = ((size_t)s->steps + 1) * TARGETS;
  s->largest        = malloc(n * sizeof *s->largest + 1);
  s->values         = malloc((3 * n + keys) * sizeof *s->values);
  SHB_CHECK(s->largest && s->values, SHB_ERR_IO, "out of memory for the scene of %zu nodes", n);
  SHB_TRY(post_period_extremes(p, INSTANTS, s->largest, &s->note->greatest_displacement));
  choose_harmonics(p, s->note);
  SHB_CHECK(s->note->n_harmonics > 0, SHB_ERR_INPUT, "nothing moves at point %d of branch %d",
            p->point, p->branch);
  s->note->scale =
      scale > 0 ? scale : GREAT * greatest_dimension(s) / s->note->greatest_displacement;
  s->note->greatest_stress = 0;
  for (int i = 0; i < s->skin.n_nodes; i++)
    s->note->greatest_stress = fmax(s->note->greatest_stress, s->largest[s->skin.node[i]]);
  return SHB_OK;
}

/* ------------------------------------------------------------------ arrays of the binary chunk */

static const char *comma(const post_buffer *list) {
  return list->length ? "," : "";
}

static void put_bounds(post_buffer *out, const char *name, const float *values, size_t n, int width,
                       bool high) {
  post_put(out, ",\"%s\":[", name);
  for (int d = 0; d < width; d++) {
    float bound = values[d];
    for (size_t i = 1; i < n; i++) {
      const float value = values[i * (size_t)width + (size_t)d];
      if (high ? value > bound : value < bound) bound = value;
    }
    post_put(out, "%s%.9g", d ? "," : "", (double)bound);
  }
  post_put(out, "]");
}

/* Append a view of the buffer with its accessor; returns the accessor's index. Views start at
 * multiples of four.
 *   width   in  1 SCALAR, 3 VEC3, 4 VEC4
 *   target  in  of the view, 0: none
 *   bounds  in  whether min and max are written; floats only */
static int add(scene *s, const void *data, size_t n, int width, int type, int target, bool bounds) {
  static const char *const kind[] = {"", "SCALAR", "", "VEC3", "VEC4"};
  const size_t             bytes  = n * (size_t)width * (type == BYTE ? 1 : 4);
  post_put(&s->views, "%s{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":%zu", comma(&s->views),
           s->binary.length, bytes);
  if (target) post_put(&s->views, ",\"target\":%d", target);
  post_put(&s->views, "}");
  post_put(&s->accessors, "%s{\"bufferView\":%d,\"componentType\":%d,\"count\":%zu,\"type\":\"%s\"",
           comma(&s->accessors), s->n_accessors, type, n, kind[width]);
  if (type == BYTE) post_put(&s->accessors, ",\"normalized\":true");
  if (bounds) {
    put_bounds(&s->accessors, "min", data, n, width, false);
    put_bounds(&s->accessors, "max", data, n, width, true);
  }
  post_put(&s->accessors, "}");
  post_put_bytes(&s->binary, data, bytes);
  while (s->binary.length % 4) post_put_bytes(&s->binary, "", 1);
  return s->n_accessors++;
}

/* values <- factor times a field at the nodes of the skin, added to the place of the node. */
static void gather(scene *s, const double *place, double factor, const double *field) {
  for (int i = 0; i < s->skin.n_nodes; i++)
    for (int d = 0; d < 3; d++) {
      const size_t at      = 3 * (size_t)s->skin.node[i] + (size_t)d;
      s->values[3 * i + d] = (float)((place ? place[at] : 0) + factor * field[at]);
    }
}

static double linear(int encoded) {
  const double v = encoded / 255.;
  return v <= 0.04045 ? v / 12.92 : pow((v + 0.055) / 1.055, 2.4);
}

/* Colours of a vertex are linear in glTF. */
static int add_colours(scene *s) {
  unsigned char *colour = (unsigned char *)s->values;
  for (int i = 0; i < s->skin.n_nodes; i++) {
    char         text[8];
    unsigned int rgb[3];
    post_colour(s->largest[s->skin.node[i]] / s->note->greatest_stress, false, text);
    if (sscanf(text, "#%2x%2x%2x", &rgb[0], &rgb[1], &rgb[2]) != 3) rgb[0] = rgb[1] = rgb[2] = 0;
    for (int c = 0; c < 3; c++)
      colour[4 * i + c] = (unsigned char)lround(255 * linear((int)rgb[c]));
    colour[4 * i + 3] = 255;
  }
  return add(s, colour, (size_t)s->skin.n_nodes, 4, BYTE, VERTICES, false);
}

/* The mesh with its targets, as JSON. */
static void put_mesh(scene *s, post_buffer *out) {
  const post_period *p = s->period;
  const size_t       n = (size_t)s->skin.n_nodes, row = 3 * (size_t)p->field->n_nodes;
  const double       scale = s->note->scale;
  post_put(out, "{\"name\":\"blade\",\"primitives\":[{\"mode\":4,\"material\":0");
  post_put(out, ",\"indices\":%d",
           add(s, s->skin.triangle, 3 * (size_t)s->skin.n_triangles, 1, UNSIGNED, INDICES, false));
  gather(s, p->field->nodes, scale, p->displacement);
  post_put(out, ",\"attributes\":{\"POSITION\":%d", add(s, s->values, n, 3, FLOAT, VERTICES, true));
  post_put(out, ",\"NORMAL\":%d", add(s, s->skin.normal, n, 3, FLOAT, VERTICES, false));
  post_put(out, ",\"COLOR_0\":%d},\"targets\":[", add_colours(s));
  for (int t = 0; t < 2 * s->note->n_harmonics; t++) {
    const size_t k = (size_t)s->note->harmonic[t / 2], part = (size_t)t % 2;
    gather(s, NULL, part ? -scale : scale, p->displacement + (2 * k + part) * row);
    post_put(out, "%s{\"POSITION\":%d}", t ? "," : "",
             add(s, s->values, n, 3, FLOAT, VERTICES, true));
  }
  post_put(out, "]}],\"weights\":[");
  for (int t = 0; t < 2 * s->note->n_harmonics; t++) post_put(out, "%s%d", t ? "," : "", 1 - t % 2);
  post_put(out, "]}");
}

/* ------------------------------------------------------------------ blades and their animation */

/* Weights of the targets of a blade at the keys, the last of which is the first again. */
static int add_weights(scene *s, int blade) {
  const int targets = 2 * s->note->n_harmonics;
  for (int i = 0; i <= s->steps; i++)
    for (int t = 0; t < targets; t++) {
      const int    k = s->note->harmonic[t / 2];
      const double angle =
          SHB_TWO_PI * k * (i % s->steps) / s->steps - post_period_lag(s->period, blade, k);
      s->values[targets * i + t] = (float)(t % 2 ? sin(angle) : cos(angle));
    }
  return add(s, s->values, (size_t)targets * ((size_t)s->steps + 1), 1, FLOAT, 0, false);
}

static void put_quaternion(post_buffer *out, const double axis[3], double angle) {
  post_put(out, "\"rotation\":[");
  for (int d = 0; d < 3; d++) post_put(out, "%.9g,", axis[d] * sin(angle / 2));
  post_put(out, "%.9g]", cos(angle / 2));
}

/* Node 0 turns the radial direction up; node 1 + b is blade b. */
static void put_blades(scene *s) {
  double axial[3], radial[3];
  mesh_axis_vector(s->period->axis, axial);
  mesh_axis_stacking(s->period->axis, radial);
  const double about[3] = {-radial[2], 0, radial[0]};
  post_put(&s->nodes, "{\"name\":\"radial up\",");
  put_quaternion(&s->nodes, about, SHB_PI / 2);
  post_put(&s->nodes, ",\"children\":[");
  for (int b = 0; b < s->copies; b++) post_put(&s->nodes, "%s%d", b ? "," : "", b + 1);
  post_put(&s->nodes, "]}");
  for (int i = 0; i <= s->steps; i++) s->values[i] = (float)(SECONDS * (double)i / s->steps);
  const int time = add(s, s->values, (size_t)s->steps + 1, 1, FLOAT, 0, true);
  for (int b = 0; b < s->copies; b++) {
    post_put(&s->nodes, ",{\"name\":\"blade %d\",\"mesh\":0,", b);
    put_quaternion(&s->nodes, axial, s->copies > 1 ? SHB_TWO_PI * b / s->copies : 0);
    post_put(&s->nodes, "}");
    post_put(&s->samplers, "%s{\"input\":%d,\"interpolation\":\"LINEAR\",\"output\":%d}",
             comma(&s->samplers), time, add_weights(s, b));
    post_put(&s->channels, "%s{\"sampler\":%d,\"target\":{\"node\":%d,\"path\":\"weights\"}}",
             comma(&s->channels), b, b + 1);
  }
}

/* ------------------------------------------------------------------ the file */

static void put_asset(const scene *s, post_buffer *out) {
  const post_period *p = s->period;
  post_put(out, "{\"asset\":{\"version\":\"2.0\",\"generator\":\"shroudhb %s\",\"extras\":{",
           shb_revision());
  post_put(out, "\"branch\":%d,\"point\":%d,\"frequency_Hz\":%.9g,\"engine_order\":%d,", p->branch,
           p->point, p->frequency, p->engine_order);
  post_put(out,
           "\"displacement_scale\":%.9g,\"greatest_displacement_m\":%.9g,"
           "\"greatest_von_mises_Pa\":%.9g,\"harmonics\":[",
           s->note->scale, s->note->greatest_displacement, s->note->greatest_stress);
  for (int i = 0; i < s->note->n_harmonics; i++)
    post_put(out, "%s%d", i ? "," : "", s->note->harmonic[i]);
  post_put(out, "]}},");
}

static void put_json(scene *s, post_buffer *out) {
  post_buffer mesh = {0};
  put_mesh(s, &mesh);
  put_blades(s);
  put_asset(s, out);
  post_put(out, "\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":[%s],\"meshes\":[%s],",
           s->nodes.text, mesh.text);
  post_put(out,
           "\"materials\":[{\"name\":\"stress\",\"doubleSided\":true,\"pbrMetallicRoughness\":"
           "{\"metallicFactor\":0,\"roughnessFactor\":0.7}}],");
  post_put(out,
           "\"animations\":[{\"name\":\"one period\",\"samplers\":[%s],\"channels\":[%s]}],"
           "\"buffers\":[{\"byteLength\":%zu}],\"bufferViews\":[%s],\"accessors\":[%s]}",
           s->samplers.text, s->channels.text, s->binary.length, s->views.text, s->accessors.text);
  out->failed = out->failed || mesh.failed;
  post_buffer_free(&mesh);
}

static void put_words(post_buffer *out, const uint32_t *word, size_t n) {
  post_put_bytes(out, (const char *)word, n * sizeof *word);
}

/* Header, a chunk of JSON padded with spaces, a chunk of binary data. */
static void put_file(scene *s, post_buffer *json, post_buffer *out) {
  while (json->length % 4) post_put(json, " ");
  const uint32_t text = (uint32_t)json->length, data = (uint32_t)s->binary.length;
  const uint32_t head[5] = {0x46546C67, 2, 12 + 8 + text + 8 + data, text, 0x4E4F534A};
  const uint32_t tail[2] = {data, 0x004E4942};
  put_words(out, head, 5);
  post_put_bytes(out, json->text, json->length);
  put_words(out, tail, 2);
  post_put_bytes(out, s->binary.text, s->binary.length);
}

static bool has_failed(const scene *s) {
  return s->binary.failed || s->views.failed || s->accessors.failed || s->samplers.failed ||
         s->channels.failed || s->nodes.failed;
}

static void free_scene(scene *s) {
  post_skin_free(&s->skin);
  free(s->largest);
  free(s->values);
  post_buffer *const all[] = {&s->binary,   &s->views,    &s->accessors,
                              &s->samplers, &s->channels, &s->nodes};
  for (size_t i = 0; i < sizeof all / sizeof all[0]; i++) post_buffer_free(all[i]);
}

shb_status post_field_scene(const post_period *period, int steps, bool ring, double scale,
                            post_scene_note *note, post_buffer *out) {
  scene s = {.period = period, .note = note, .steps = steps, .copies = ring ? period->blades : 1};
  post_buffer json   = {0};
  shb_status  status = prepare(&s, scale);
  if (status == SHB_OK) {
    put_json(&s, &json);
    put_file(&s, &json, out);
    if (json.failed || has_failed(&s)) out->failed = true;
  }
  post_buffer_free(&json);
  free_scene(&s);
  SHB_TRY(status);
  SHB_CHECK(!out->failed, SHB_ERR_IO, "out of memory for the scene");
  return SHB_OK;
}

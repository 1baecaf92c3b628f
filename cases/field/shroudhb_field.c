/* shroudhb-field: the moving blade of a response, for ParaView and for viewers of glTF. No MPI. */
#include <cblas.h>
#include <stdio.h>

#include "cases/commands/command.h"
#include "cases/field/face_command.h"
#include "cases/field/field_command.h"
#include "mesh/base/progress.h"

static const char usage[] =
    "usage: shroudhb-field [--quiet] [--branch B [--point P]] [--peak N] [--ring | --face]\n"
    "                      [--steps N] [--scale S] [--modal FILE] NAME.response.h5\n"
    "       shroudhb-field [--quiet] --mode I [--nodal-diameter N] [--ring] [--steps N] [--scale "
    "S]\n"
    "                      NAME.modal.h5\n"
    "\n"
    "Writes one period of the motion and stress of the whole blade at a point of the response:\n"
    "NAME.field.vtkhdf  for ParaView 5.12 and VTK 9.3 or later\n"
    "NAME.field.glb     the surface, moving, coloured by stress, for any viewer of glTF\n"
    "\n"
    "  --branch B    a curve, as inspect counts them; default: the nonlinear ones\n"
    "  --point P     a kept point of it; default: the highest peak\n"
    "  --peak N      the N-th highest of the kept peaks, from 1\n"
    "  --ring        all blades at their phases: NAME.ring.vtkhdf, NAME.ring.glb\n"
    "  --face        the contact face at a peak, what friction does there: NAME.face.vtkhdf\n"
    "  --mode I      a mode of the modal file, from 1: NAME.field_mode_I.vtkhdf, or of a disc\n"
    "                NAME.field_mode_N_I.vtkhdf; the greatest displacement is 1 mm\n"
    "  --nodal-diameter N  of a disc, default 0; with --ring the wave runs around all sectors\n"
    "  --steps N     instants of the period, 2 to 1000; default: 24\n"
    "  --scale S     of the displacement in the .glb; default: the greatest is 5 % of the blade\n"
    "  --modal FILE  default: NAME.modal.h5 beside the response\n"
    "\n"
    "A chosen point is added to the names: NAME.field_B_P. Which points are kept: mhb.save.\n"
    "The whole blade stands in the modal file of shroudhb modal; one from elsewhere may lack it.\n";

int main(int argc, char **argv) {
  field_options   field;
  command_options options;
  int             code = field_options_take(&argc, argv, &field);
  if (code < 0) code = command_parse(argc, argv, usage, &options);
  if (code >= 0) return code;
  field.response = options.path;
  openblas_set_num_threads(1);
  shb_interrupt_catch();
  FILE *out = options.quiet ? NULL : stdout;
  return command_finish(field.face ? face_command(&field, out) : field_command(&field, out));
}

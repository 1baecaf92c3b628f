/* Parts of an .inp file, the instances that place them, and systems of coordinates. */
#ifndef MESH_IO_INP_PARTS_H
#define MESH_IO_INP_PARTS_H

#include "mesh/io/inp_table.h"

/* Outside parts all cards go into `whole`; in a part into its own table, until an instance puts it
 * into the whole. */
typedef struct {
  char     name[MESH_DECK_NAME];
  mesh_inp table;
} mesh_inp_part;

typedef struct {
  mesh_deck         *deck;
  mesh_inp          *whole, *inp; /* inp: into which cards go */
  int                n_parts, part_room, n_instances, instance_room;
  mesh_inp_part    **part;
  mesh_inp_instance *instance;
  int                inside;     /* the instance whose block is read, or -1 */
  mesh_inp_instance  own;        /* of nodes and elements outside parts, beside instances */
  int                n_raised;   /* instances that `own` follows */
  bool               has_system; /* *SYSTEM is on */
  mesh_inp_map       system;
} mesh_inp_model;

/* Cards of parts, assemblies, instances and systems.
 *   known  out  false: the card is another one, and its rows are not read */
shb_status mesh_inp_parts_card(mesh_inp_model *model, const mesh_card *card, bool *known);

/* The instance whose numbers a card uses, by INSTANCE= or by its place. Beside instances the whole
 * has numbers of its own from its first node or element there on. */
shb_status mesh_inp_parts_of(mesh_inp_model *model, const mesh_card *card,
                             const mesh_inp_instance **instance);

/* At the end of the deck: a single part without an instance is the model. */
shb_status mesh_inp_parts_end(mesh_inp_model *model);

void mesh_inp_parts_free(mesh_inp_model *model); /* the whole is not its own */

#endif

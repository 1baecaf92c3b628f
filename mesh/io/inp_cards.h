/* The cards of an .inp file that define a mesh. */
#ifndef MESH_IO_INP_CARDS_H
#define MESH_IO_INP_CARDS_H

#include "mesh/io/inp_table.h"

/* Read *NODE, *ELEMENT, *NSET, *ELSET, *SURFACE, parts and systems. Other cards that change the
 * mesh (*NGEN, ...) are refused. The rest (materials, steps) is skipped. SHB_ERR_INPUT,
 * SHB_ERR_IO. */
shb_status mesh_inp_cards(mesh_deck *deck, mesh_inp *inp);

#endif

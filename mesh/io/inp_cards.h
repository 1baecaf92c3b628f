/* The cards of an .inp file that make up a mesh. */
#ifndef MESH_IO_INP_CARDS_H
#define MESH_IO_INP_CARDS_H

#include "mesh/io/inp_table.h"

/* Read every card: *NODE, *ELEMENT, *NSET, *ELSET, *SURFACE; other cards that change the mesh (*INCLUDE, *NGEN, ...) are
 * refused, the rest (materials, steps) is passed over. SHB_ERR_INPUT, SHB_ERR_IO. */
shb_status mesh_inp_cards(mesh_deck *deck, mesh_inp *inp);

#endif

/* Where friction works, as a section of the report page. */
#ifndef POSTPROC_FIELD_CONTACT_SECTION_H
#define POSTPROC_FIELD_CONTACT_SECTION_H

#include "mesh/base/axes.h"
#include "postproc/draw/text_buffer.h"
#include "postproc/field/contact_map.h"

/* Append a section of HTML: dissipation, slip and mean pressure over the contact face, at the
 * highest peak of each curve. The face is seen from outside the blade, with the radial direction
 * upwards. At most six curves, those that dissipate most. Nothing is appended where all maps are
 * even, as with one contact point.
 *   path  in  the response file
 * Errors: of post_contact_face_read; SHB_ERR_IO no memory. */
shb_status post_contact_section(const char *path, const mhb_response *response, mesh_axis axis,
                                post_buffer *out);

#endif

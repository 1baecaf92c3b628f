/* The rows of the key table. */
#include "cases/parse/key_table.h"

/* NOLINTBEGIN(bugprone-macro-parentheses): texts that are joined, members of an initialiser */
#define AT(member) .at = offsetof(case_file, member)
#define LIST(member, count) \
  AT(member), .count_at = offsetof(case_file, count), .each = sizeof(*((case_file *)0)->member)
#define LISTED(member, count, most) AT(member), .count_at = offsetof(case_file, count), .room = most
/* Where a member of the only, or of the first, element of a list is; of any element. */
#define FIRST(list, member) AT(list[0].member), .element = offsetof(case_file, list)
#define FIRST_MATERIAL(member) FIRST(materials, member)
#define FIRST_LOAD(member) FIRST(loads, member)
#define FIRST_INTERFACE(member) FIRST(interfaces, member)
#define MATERIAL(member) .at = offsetof(case_material, member)
#define LOAD(member) .at = offsetof(case_load, member)
#define INTERFACE(member) .at = offsetof(case_interface, member)
#define FIRST_COUNT(member) .count_at = offsetof(case_file, interfaces[0].member)
#define INTERFACE_COUNT(member) .count_at = offsetof(case_interface, member)
#define VARIED(member) AT(member), .element = offsetof(case_file, member)
#define SECTION(member) .at = offsetof(mesh_section, member)
#define COUNT(array) ((int)(sizeof(array) / sizeof *(array)))

enum { MOST_HARMONICS = 200 };

/* Angles in the range column are rad: 1.5708 is 90 deg. */
#define RIGHT_ANGLE 1.5707963267948966

/* clang-format off */

/* Keys of a material: material.KEY of the only one, materials[].KEY of one of several. */
#define MATERIAL_KEYS(PATH, IN, WHEN)                                                              \
  {PATH "E", CASE_TRIPLE, "Pa", 1e6, 1e14, .required = true, IN(constants.E),                      \
   .stages = CASE_MODAL, .when = WHEN,                                                             \
   .help = "Young's modulus; with G of a single crystal, along its axes: a number or [E1, E2, "    \
           "E3]"},                                                                                 \
  {PATH "nu", CASE_TRIPLE, "", -1, 0.5, true, true, .required = true, IN(constants.nu),            \
   .stages = CASE_MODAL, .when = WHEN,                                                             \
   .help = "Poisson's ratio, or [nu12, nu13, nu23]: contraction along the second under tension "   \
           "along the first"},                                                                     \
  {PATH "G", CASE_TRIPLE, "Pa", 1e6, 1e14, IN(constants.G), .stages = CASE_MODAL,                  \
   .when = WHEN, .only = CASE_IF_CRYSTAL,                                                          \
   .help = "shear modulus of a cubic material, or [G12, G13, G23] of an orthotropic one; "         \
           "default: isotropic"},                                                                  \
  {PATH "axis_1", CASE_VECTOR, "", -1e6, 1e6, .fallback = "[1, 0, 0]", IN(constants.axis),         \
   .stages = CASE_MODAL, .when = WHEN, .only = CASE_IF_CRYSTAL,                                    \
   .help = "direction of the material's axis 1, mesh axes"},                                       \
  {PATH "axis_2", CASE_VECTOR, "", -1e6, 1e6, .fallback = "[0, 1, 0]", IN(constants.in_plane),     \
   .stages = CASE_MODAL, .when = WHEN, .only = CASE_IF_CRYSTAL,                                    \
   .help = "a direction in the plane of axes 1 and 2, on the side of 2"},                          \
  {PATH "rho", CASE_NUMBER, "kg/m3", 10, 1e5, .required = true, IN(material.rho),                  \
   .stages = CASE_MODAL, .when = WHEN,                                                             \
   .help = "density"},                                                                             \
  {PATH "fatigue.endurance", CASE_NUMBER, "Pa", 0, 1e12, true, IN(endurance),                      \
   .stages = CASE_POST, .when = WHEN,                                                              \
   .help = "stress amplitude borne without mean stress, for the safety at every peak"},            \
  {PATH "fatigue.ultimate", CASE_NUMBER, "Pa", 0, 1e12, true, IN(ultimate),                        \
   .stages = CASE_POST, .when = WHEN,                                                              \
   .help = "tensile strength, the mean stress borne without vibration (Goodman's line)"},

/* Keys of a load: excitation.KEY of the only one, excitation.loads[].KEY of one of several. */
#define LOAD_KEYS(PATH, IN, WHEN, REQUIRED)                                                        \
  {PATH "pressure", CASE_NUMBER, "Pa", -1e12, 1e12, .required = REQUIRED, .spare = true,           \
   .instead = "traction, force, field or loads", IN(load.pressure), .stages = CASE_MODAL,          \
   .when = WHEN, .only = CASE_IF_PRESSURE,                                                         \
   .help = "on the loaded faces, into the surface; one of pressure, traction, force, field"},      \
  {PATH "traction", CASE_VECTOR, "Pa", -1e12, 1e12, .required = true, IN(load.traction),           \
   .stages = CASE_MODAL, .when = WHEN, .only = CASE_IF_TRACTION,                                   \
   .help = "on the loaded faces, along a direction in mesh axes"},                                 \
  {PATH "force.at", CASE_VECTOR, "m", -1e3, 1e3, IN(load.at), .stages = CASE_MODAL,                \
   .when = WHEN, .only = CASE_IF_FORCE_AT,                                                         \
   .help = "where the force acts: the node nearest to it; default: the first probe"},              \
  {PATH "force.vector", CASE_VECTOR, "N", -1e12, 1e12, .required = true, IN(load.force),           \
   .stages = CASE_MODAL, .when = WHEN, .only = CASE_IF_FORCE,                                      \
   .help = "force in mesh axes"},                                                                  \
  {PATH "field", CASE_FILE_NAME, "", .required = true, IN(field), .stages = CASE_MODAL,            \
   .when = WHEN, .only = CASE_IF_FIELD,                                                            \
   .help = "HDF5 file of forces at nodes or of pressure at loaded nodes, amplitude and "           \
           "phase a harmonic"},                                                                    \
  {PATH "harmonics", CASE_FACTORS, "", .fallback = "{1: [1, 0 deg]}", IN(load),                    \
   .stages = CASE_MODAL, .when = WHEN, .only = CASE_IF_FACTORS,                                    \
   .help = "factor and phase of the load a harmonic: {k: [factor, phase]}, k from 0 to 64"},

/* Keys of an interface: contact.KEY of the only one, contact.interfaces[].KEY of one of several. */
#define FACE_KEYS(PATH, IN, WHEN, OWN)                                                             \
  {PATH "psi", CASE_NUMBER, "rad", -RIGHT_ANGLE, RIGHT_ANGLE, true, true, IN(mhb.psi),             \
   .stages = CASE_MESH | CASE_MODAL | CASE_MHB, .when = WHEN, .only = CASE_IF_PSI,                 \
   .help = "shroud angle: turns the normal v of the right face from tangential towards axial; "    \
           "default: from the faces (parametric blade: 0)"},                                       \
  {PATH "phi", CASE_NUMBER, "rad", -RIGHT_ANGLE, RIGHT_ANGLE, true, true, IN(mhb.phi),             \
   .stages = CASE_MESH | CASE_MODAL | CASE_MHB, .when = WHEN, .only = CASE_IF_PHI,                 \
   .help = "inclination: turns that normal towards the engine axis; default: from the faces "      \
           "(parametric blade: 0)"},                                                               \
  {PATH "points", CASE_COUNT, "", 1, 100000, .words = "auto", .fallback = "1", IN(points),         \
   .stages = CASE_MODAL, .when = OWN,                                                              \
   .help = "patches of the contact face, or all: one a node; auto: as few as contact.tolerance "   \
           "allows"},

#define LAW_KEYS(PATH, IN, COUNT_AT, WHEN)                                                         \
  {PATH "mu", CASE_NUMBER, "", 0, 1e6, .required = true, IN(mhb.mu), .stages = CASE_MHB,           \
   .when = WHEN,                                                                                   \
   .help = "friction coefficient"},                                                                \
  {PATH "ku", CASE_STIFFNESS, "N/m", 0, 1e15, true, .required = true, IN(mhb.ku),                  \
   .stages = CASE_MHB, .when = WHEN,                                                               \
   .help = "tangential stiffness of the interface: a number or [kuu, kuw, kww]"},                  \
  {PATH "kv", CASE_NUMBER, "N/m", 0, 1e15, .required = true, IN(mhb.kv), .stages = CASE_MHB,       \
   .when = WHEN,                                                                                   \
   .help = "normal stiffness of the interface"},                                                   \
  {PATH "n0", CASE_PRELOADS, "N", -1e12, 1e12, .required = true, IN(mhb.n0),                       \
   COUNT_AT(mhb.n_preloads), .stages = CASE_MHB, .when = WHEN,                                     \
   .help = "normal preload, negative for a gap of -n0/kv: a number, a list, or {from, to, "        \
           "points}; lists of several interfaces have one length"},

/* NOLINTEND(bugprone-macro-parentheses) */

static const case_key table[] = {
    {"name", CASE_WORD, "", AT(name), .stages = CASE_POST,
     .help = "name of the output files; default: the file's name, or its folder's for case.yaml"},

    {"mesh.file", CASE_FILE_NAME, "", AT(mesh_file), .stages = CASE_MESH | CASE_MODAL,
     .when = CASE_IF_MESH_FILE,
     .help = "instead of blade: a mesh (.msh, Abaqus/CalculiX .inp) or a solid (.step, .brep, "
             ".geo) with the groups root, contact_right, contact_left, load"},
    {"mesh.unit", CASE_CHOICE, "", .words = "m cm mm in", .fallback = "m", AT(mesh_unit),
     .stages = CASE_MESH, .when = CASE_IF_MESH_FILE,
     .help = "unit of the coordinates in mesh.file; a STEP file has its own"},
    {"mesh.size", CASE_NUMBER, "m", 0, 100, .fallback = "0 m", AT(source.size), .stages = CASE_MESH,
     .when = CASE_IF_SIZE,
     .help = "element size of a solid; 0: as a .geo file says"},
    {"mesh.curvature", CASE_NUMBER, "", 0, 100, .fallback = "0", AT(source.curvature),
     .stages = CASE_MESH, .when = CASE_IF_SIZE,
     .help = "elements that a full turn of a curved face of a solid would have, such as 8: smaller "
             "ones there, down to a twentieth of mesh.size; 0: mesh.size everywhere"},
    {"mesh.groups", CASE_GROUPS, "", .fallback = "{}", AT(source.rules), .stages = CASE_MESH,
     .when = CASE_IF_MESH_FILE,
     .help = "groups by rule: {GROUP: {plane: point, normal: vector} | {radius: r} | {nearest: "
             "point} | {name: the file's}}, tolerance 1e-6 m; volumes by nearest or name"},
    {"mesh.blade.root.length", CASE_NUMBER, "m", 0, 100, true, .required = true,
     AT(blade.root_length), .stages = CASE_MESH, .when = CASE_IF_BLADE,
     .help = "root block, axial"},
    {"mesh.blade.root.width", CASE_NUMBER, "m", 0, 100, true, .required = true,
     AT(blade.root_width), .stages = CASE_MESH, .when = CASE_IF_BLADE,
     .help = "root block, tangential"},
    {"mesh.blade.root.height", CASE_NUMBER, "m", 0, 100, true, .required = true,
     AT(blade.root_height), .stages = CASE_MESH, .when = CASE_IF_BLADE,
     .help = "root block, radial, below the first section"},
    {"mesh.blade.disc.bore", CASE_NUMBER, "m", 0, 100, true, .required = true, AT(blade.disc_bore),
     .stages = CASE_MESH, .when = CASE_IF_DISC,
     .help = "a disc below the root block: radius of its bore, which is clamped"},
    {"mesh.blade.disc.web", CASE_NUMBER, "m", 0, 100, true, .required = true, AT(blade.disc_web),
     .stages = CASE_MESH, .when = CASE_IF_DISC,
     .help = "axial thickness of the web"},
    {"mesh.blade.disc.rim", CASE_NUMBER, "m", 0, 100, true, .required = true, AT(blade.disc_rim),
     .stages = CASE_MESH, .when = CASE_IF_DISC,
     .help = "radial height of the rim, which is as long as the root block"},
    {"mesh.blade.disc.taper", CASE_NUMBER, "m", 0, 100, .fallback = "0 m", AT(blade.disc_taper),
     .stages = CASE_MESH, .when = CASE_IF_DISC,
     .help = "radial height below the rim over which the web widens to the length of the rim; "
             "hexahedra need one; 0: a step"},
    {"mesh.blade.sections", CASE_LIST, "", 2, MESH_MAX_SECTIONS, .required = true,
     LIST(blade.section, blade.n_sections), .stages = CASE_MESH, .when = CASE_IF_BLADE,
     .help = "airfoil sections, 2 to 16, radius increasing: a list of {radius, chord, thickness, "
             "camber, twist}"},
    {"mesh.blade.sections[].radius", CASE_NUMBER, "m", 0, 100, true, .required = true,
     SECTION(radius), .stages = CASE_MESH,
     .help = "distance from the engine axis"},
    {"mesh.blade.sections[].chord", CASE_NUMBER, "m", 0, 100, true, .required = true,
     SECTION(chord), .stages = CASE_MESH,
     .help = "chord length"},
    {"mesh.blade.sections[].thickness", CASE_NUMBER, "m", 0, 100, true, .required = true,
     SECTION(thickness), .stages = CASE_MESH,
     .help = "greatest thickness, 1 % to 50 % of the chord"},
    {"mesh.blade.sections[].camber", CASE_NUMBER, "m", -100, 100, .fallback = "0 m",
     SECTION(camber), .stages = CASE_MESH,
     .help = "height of the mean line over the chord, at most 40 % of the chord either way"},
    {"mesh.blade.sections[].twist", CASE_NUMBER, "rad", -RIGHT_ANGLE, RIGHT_ANGLE, true, true,
     .fallback = "0 deg", SECTION(twist), .stages = CASE_MESH,
     .help = "stagger from the axial direction; positive: trailing edge towards +tangential; -80 "
             "to 80 deg"},
    {"mesh.blade.shroud.length", CASE_NUMBER, "m", 0, 100, true, .required = true,
     AT(blade.shroud_length), .stages = CASE_MESH, .when = CASE_IF_BLADE,
     .help = "shroud, axial"},
    {"mesh.blade.shroud.thickness", CASE_NUMBER, "m", 0, 100, true, .required = true,
     AT(blade.shroud_thickness), .stages = CASE_MESH, .when = CASE_IF_BLADE,
     .help = "shroud, radial; it sits on the last section"},
    {"mesh.blade.shroud.contact", CASE_NUMBER, "m", 0, 100, true, .required = true,
     AT(blade.shroud_contact), .stages = CASE_MESH, .when = CASE_IF_BLADE,
     .help = "length of the contact face, the middle leg of the Z"},
    {"mesh.blade.size", CASE_NUMBER, "m", 0, 100, true, .required = true, AT(blade.size),
     .stages = CASE_MESH, .when = CASE_IF_BLADE,
     .help = "element size"},
    {"mesh.blade.shroud_size", CASE_NUMBER, "m", 0, 100, .fallback = "0 m", AT(blade.shroud_size),
     .stages = CASE_MESH, .when = CASE_IF_BLADE,
     .help = "element size in the shroud; 0: as size"},

    {"mesh.blade.elements", CASE_CHOICE, "", .words = "tet10 hex20", .fallback = "hex20",
     AT(blade.elements), .stages = CASE_MESH, .when = CASE_IF_BLADE,
     .help = "hexahedra of twenty nodes swept along the blade, or tetrahedra of ten"},

    MATERIAL_KEYS("material.", FIRST_MATERIAL, CASE_IF_MATERIAL)

    {"materials", CASE_LIST, "", 1, MESH_MAX_VOLUMES, LIST(materials, n_materials),
     .stages = CASE_MESH | CASE_MODAL, .when = CASE_IF_MATERIALS,
     .help = "instead of material, where mesh.file has several volumes: a list of {group, E, nu, "
             "rho, ...}, every element in one group"},
    {"materials[].group", CASE_LABEL, "", .required = true, MATERIAL(group),
     .stages = CASE_MESH | CASE_MODAL,
     .help = "physical volume of the mesh or solid, element set of an .inp file, or a group that "
             "mesh.groups finds by name or nearest point"},
    MATERIAL_KEYS("materials[].", MATERIAL, CASE_ALWAYS)

    {"rotor.blades", CASE_INTEGER, "", 2, 1000, .required = true, .spare = true, AT(blades),
     .stages = CASE_MESH | CASE_MODAL | CASE_MHB, .when = CASE_IF_SECTOR,
     .help = "number of blades; the sector angle is 360 deg / blades"},
    {"rotor.mistuning", CASE_MISTUNING, "", -0.5, 1, true, AT(mistuning), .stages = CASE_MHB,
     .when = CASE_IF_MISTUNED,
     .help = "relative frequency deviations, one a blade; or {file: x.csv}, a line a blade, one "
             "number or one a mode, with {unit: Hz, mean: 117 Hz} frequencies; or {deviation: 1 %, "
             "seed: 7, samples: 100}, normal; then the whole ring is solved"},
    {"rotor.speed", CASE_PRELOADS, "rad/s", 0, 1e5, .fallback = "0 rpm", AT(speed),
     .count_at = offsetof(case_file, n_speeds), .stages = CASE_MODAL, .when = CASE_IF_OWN_MODES,
     .help = "rotation speed: modes about the static equilibrium under the centrifugal load; 0: at "
             "rest; a list or {from, to, points}: a Campbell diagram, the response at the last of "
             "them, or along them with mhb.run_up"},
    {"rotor.turns", CASE_SWITCH, "", .words = "left right", .fallback = "left",
     AT(mhb.turns_right), .stages = CASE_MHB, .only = CASE_IF_RIGHT,
     .help = "the rotor turns towards -tangential (left) or +tangential (right); engine orders are "
             "then those of the machine"},
    {"rotor.coriolis", CASE_CHOICE, "", .words = "no left right yes", .fallback = "no",
     AT(coriolis), .stages = CASE_MODAL, .when = CASE_IF_OWN_MODES,
     .help = "yes: with Coriolis terms at rotor.speed; left or right: of a rotor that turns so, "
             "where rotor.turns is not given and engine_order is E or blades - E"},
    {"rotor.pressure", CASE_NUMBER, "Pa", -1e12, 1e12, .fallback = "0 Pa", AT(pressure),
     .stages = CASE_MODAL, .when = CASE_IF_OWN_MODES,
     .help = "steady gas pressure on the group load, into the deformed surface: part of the static "
             "equilibrium"},
    {"rotor.axis", CASE_CHOICE, "", .words = "x y z -x -y -z", .fallback = "x", AT(axis),
     .stages = CASE_MESH | CASE_MODAL, .when = CASE_IF_OWN_MODES,
     .help = "engine axis, through the origin"},

    {"modal.modes", CASE_AUTO, "", 1, 1000, .fallback = "20", AT(modes), .stages = CASE_MODAL,
     .when = CASE_IF_OWN_MODES,
     .help = "modes kept; what is left out goes into the residual flexibility; auto: as few as "
             "modal.tolerance allows"},
    {"modal.tolerance", CASE_NUMBER, "", 0, 1, true, .fallback = "1e-6", AT(tolerance),
     .stages = CASE_MODAL, .when = CASE_IF_AUTO_MODES,
     .help = "with modes: auto, the relative error of the receptance at the contact up to "
             "modal.band"},
    {"modal.band", CASE_NUMBER, "Hz", 0, 1e9, .fallback = "0 Hz", AT(band), .stages = CASE_MODAL,
     .when = CASE_IF_AUTO_MODES,
     .help = "with modes: auto; 0: the upper end of mhb.frequency times mhb.harmonics (times 5 "
             "where they are auto)"},
    {"modal.damping", CASE_DAMPING, "", 0, 1, .below = true, .required = true, .spare = true,
     AT(damping), .stages = CASE_MODAL, .when = CASE_IF_OWN_MODES,
     .help = "damping ratio of every mode; [ratio of each], the last for those beyond; "
             "{loss_factor: eta}; {rayleigh: [alpha 1/s, beta s]}"},
    {"modal.check", CASE_CHOICE, "", .words = "auto inertia never", .fallback = "auto", AT(check),
     .stages = CASE_MODAL, .when = CASE_IF_OWN_MODES,
     .help = "that no mode is missing: by a search of what the modes leave out (auto), or by "
             "counting with a second factorisation"},
    {"modal.nodal_diameters", CASE_WORD_OR_INTEGERS, "", 0, 500, .words = "auto all",
     .fallback = "auto", LISTED(diameters.list, diameters.n, CASE_MOST_DIAMETERS),
     .what_at = offsetof(case_file, diameters.what), .stages = CASE_MODAL,
     .when = CASE_IF_OWN_MODES, .only = CASE_IF_DIAMETERS,
     .help = "of a sector with a disc (groups cyclic_right, cyclic_left): those that the harmonics "
             "need, 0 to N/2 (stability needs all), or a list"},
    {"modal.integration", CASE_SWITCH, "", .words = "reduced full", .fallback = "reduced",
     AT(full_integration), .stages = CASE_MODAL, .when = CASE_IF_OWN_MODES,
     .help = "points of the stiffness: hexahedra 2x2x2 or 3x3x3, curved tetrahedra 4 or 27"},
    {"modal.file", CASE_FILE_NAME, "", AT(modal_file), .stages = CASE_MHB,
     .when = CASE_IF_MODAL_FILE,
     .help = "modal file to use; mesh, material, rotor.speed and the load are then not needed"},

    {"excitation.engine_order", CASE_INTEGER, "", 0, 10000, .required = true, AT(engine_order),
     .stages = CASE_MHB, .when = CASE_IF_ORDER,
     .help = "engine order E; the right neighbour lags by 2 pi E / blades, or leads by it with "
             "rotor.turns: right"},
    LOAD_KEYS("excitation.", FIRST_LOAD, CASE_IF_LOAD, true)
    {"excitation.loads", CASE_LIST, "", 1, CASE_MAX_LOADS, LIST(loads, n_loads),
     .stages = CASE_MESH | CASE_MODAL, .when = CASE_IF_LOADS,
     .help = "instead of one load: a list of loads that act together, each one of pressure, "
             "traction, force, field"},
    {"excitation.loads[].group", CASE_LABEL, "", .fallback = "load", LOAD(group),
     .stages = CASE_MESH | CASE_MODAL,
     .help = "group of faces that the pressure or traction acts on"},
    LOAD_KEYS("excitation.loads[].", LOAD, CASE_ALWAYS, false)

    {"probe", CASE_PROBES, "m", -1e3, 1e3, .fallback = "{}", AT(probe), .stages = CASE_MODAL,
     .when = CASE_IF_OWN_MODES,
     .help = "nodes to watch, at most 32: {name: [x, y, z]}, the nearest node to each"},

    {"gauge", CASE_GAUGES, "m", -1e3, 1e3, .fallback = "{}", AT(gauge), .stages = CASE_POST,
     .when = CASE_IF_OWN_MODES,
     .help = "strain gauges, at most 32: {name: {at: [x, y, z], direction: [x, y, z]}}, on the "
             "nearest point of the surface, mesh axes"},

    {"contact.to", CASE_SWITCH, "", .words = "neighbour ground", .fallback = "neighbour",
     AT(mhb.to_ground), .stages = CASE_MODAL | CASE_MHB,
     .help = "what the right contact face meets"},
    FACE_KEYS("contact.", FIRST_INTERFACE, CASE_IF_INTERFACE, CASE_IF_POINTS)
    {"contact.tolerance", CASE_NUMBER, "", 1e-6, 0.5, .fallback = "1e-3", AT(points_tolerance),
     .stages = CASE_MHB | CASE_INTEGRATE, .when = CASE_IF_PATCHES,
     .help = "spatial error that contact.points: auto allows, relative to the motion"},
    LAW_KEYS("contact.", FIRST_INTERFACE, FIRST_COUNT, CASE_IF_INTERFACE)
    {"contact.preload", CASE_CHOICE, "", .words = "equilibrium interference",
     .fallback = "equilibrium", AT(mhb.preload), .stages = CASE_MHB,
     .help = "n0 is the load at rest, or an interference that also deflects the blade"},
    {"contact.accuracy", CASE_ACCURACY, "", 1e-14, 1e-2, .words = "fast balanced exact",
     .fallback = "exact", AT(mhb.tolerance), .stages = CASE_MHB,
     .help = "relative tolerance of the contact law: fast 1e-3, balanced 1e-5, exact 1e-8, or a "
             "number, 1e-14 to 0.01"},

    {"contact.interfaces", CASE_LIST, "", 1, MHB_MAX_INTERFACES, LIST(interfaces, n_interfaces),
     .stages = CASE_MESH | CASE_MODAL | CASE_MHB, .when = CASE_IF_INTERFACES,
     .help = "several interfaces (a shroud, a mid-span snubber), instead of psi to n0 above: a "
             "list of {name, right, left, points, mu, ku, kv, n0}"},
    {"contact.interfaces[].name", CASE_LABEL, "", .required = true, INTERFACE(mhb.name),
     .stages = CASE_MODAL | CASE_MHB,
     .help = "name in the modal and the response file"},
    {"contact.interfaces[].right", CASE_LABEL, "", .fallback = "contact_right", INTERFACE(right),
     .stages = CASE_MESH | CASE_MODAL,
     .help = "group of its right face"},
    {"contact.interfaces[].left", CASE_LABEL, "", .fallback = "contact_left", INTERFACE(left),
     .stages = CASE_MESH | CASE_MODAL,
     .help = "group of its left face; not to ground"},
    {"contact.interfaces[].to", CASE_SWITCH, "", .words = "neighbour ground",
     INTERFACE(mhb.to_ground), .stages = CASE_MODAL | CASE_MHB,
     .help = "what its right face meets; default: contact.to"},
    FACE_KEYS("contact.interfaces[].", INTERFACE, CASE_ALWAYS, CASE_IF_OWN_MODES)
    LAW_KEYS("contact.interfaces[].", INTERFACE, INTERFACE_COUNT, CASE_IF_INTERFACES)

    {"mhb.frequency", CASE_SWEEP, "Hz", 0, 1e9, true, .required = true, AT(mhb.frequency),
     .stages = CASE_MHB,
     .help = "range of the sweep: [from, to]; with mhb.vary one number, but for mhb.track"},
    {"mhb.run_up", CASE_SWITCH, "", .words = "no yes", .fallback = "no", AT(run_up),
     .stages = CASE_MHB, .when = CASE_IF_RUN_UP,
     .help = "the rotor's speed is the excitation frequency / engine order: modes of the speeds in "
             "rotor.speed (or in a modal file of several speeds), interpolated"},
    {"mhb.vary.n0", CASE_INTERVAL, "N", -1e12, 1e12, VARIED(vary[MHB_IN_N0]), .stages = CASE_MHB,
     .when = CASE_IF_FOLLOWED,
     .help = "curves follow this instead of the frequency: the preload"},
    {"mhb.vary.scale", CASE_INTERVAL, "", 0, 1e12, VARIED(vary[MHB_IN_SCALE]), .stages = CASE_MHB,
     .when = CASE_IF_FOLLOWED,
     .help = "or the level of the excitation, in place of mhb.scale"},
    {"mhb.vary.mu", CASE_INTERVAL, "", 0, 1e6, VARIED(vary[MHB_IN_MU]), .stages = CASE_MHB,
     .when = CASE_IF_FOLLOWED,
     .help = "or the friction coefficient, in place of contact.mu"},
    {"mhb.vary.ku", CASE_INTERVAL, "N/m", 0, 1e15, true, VARIED(vary[MHB_IN_KU]),
     .stages = CASE_MHB, .when = CASE_IF_FOLLOWED,
     .help = "or kuu; kuw and kww stay in the proportion that contact.ku gives"},
    {"mhb.vary.kv", CASE_INTERVAL, "N/m", 0, 1e15, VARIED(vary[MHB_IN_KV]), .stages = CASE_MHB,
     .when = CASE_IF_FOLLOWED,
     .help = "or the normal stiffness, in place of contact.kv"},
    {"mhb.vary.interface", CASE_LABEL, "", AT(vary_interface), .stages = CASE_MHB,
     .when = CASE_IF_VARIED,
     .help = "of several interfaces the one whose n0, mu, ku or kv that is, the others keep theirs "
             "(default: the first); all: in proportion"},
    {"mhb.track", CASE_CHOICE, "", .words = "nothing peak fold flip neimark-sacker",
     .fallback = "nothing", AT(mhb.track), .stages = CASE_MHB, .when = CASE_IF_TRACKED,
     .help = "with mhb.vary: follow the resonance peaks, the folds, or where the motion doubles "
             "its period (flip) or begins to be modulated (neimark-sacker), along the parameter; "
             "their frequency, within mhb.frequency, is unknown too"},
    {"mhb.output", CASE_LABEL, "", AT(mhb.output), .stages = CASE_MHB, .when = CASE_IF_TRACKED,
     .help = "whose peak: a probe, or contact for the first contact point; default: the first "
             "probe"},
    {"mhb.output_quantity", CASE_CHOICE, "", .words = "harmonic peak_to_peak rss",
     .fallback = "harmonic", AT(mhb.output_quantity), .stages = CASE_MHB, .when = CASE_IF_TRACKED,
     .help = "its size: the largest displacement of one harmonic, as in reports and studies; peak "
             "to peak, the largest distance between two instants of a period; or rss, the root of "
             "the sum of the squares of the harmonic's three components"},
    {"mhb.output_harmonic", CASE_INTEGER, "", 1, 15, .fallback = "1", AT(mhb.output_harmonic),
     .stages = CASE_MHB, .when = CASE_IF_TRACKED,
     .help = "harmonic of the excitation whose amplitude that is; of the motion there must be as "
             "many, times mhb.subharmonics"},
    {"mhb.harmonics", CASE_AUTO, "", 1, MOST_HARMONICS, .fallback = "3", AT(mhb.harmonics),
     .stages = CASE_MHB,
     .help = "harmonics of the balance, counted in the fundamental; auto: chosen at each point by "
             "mhb.tolerance, at most 31"},
    {"mhb.tolerance", CASE_NUMBER, "", 1e-8, 0.1, .fallback = "1e-4", AT(mhb.motion_tolerance),
     .stages = CASE_MHB, .when = CASE_IF_AUTO,
     .help = "with harmonics: auto, the relative error of the motion that the harmonics left out "
             "may cause"},
    {"mhb.subharmonics", CASE_INTEGER, "", 1, 16, .fallback = "1", AT(mhb.subharmonics),
     .stages = CASE_MHB,
     .help = "order nu: the fundamental is the excitation frequency / nu"},
    {"mhb.scale", CASE_NUMBER, "", 0, 1e12, .fallback = "1", AT(mhb.scale), .stages = CASE_MHB,
     .when = CASE_IF_NOT_SCALED,
     .help = "multiplies the excitation"},
    {"mhb.max_points", CASE_INTEGER, "", 10, 1000000, .fallback = "20000", AT(mhb.max_points),
     .stages = CASE_MHB,
     .help = "points after which a branch ends"},
    {"mhb.stability", CASE_CHOICE, "", .words = "auto always never", .fallback = "auto",
     AT(mhb.stability), .stages = CASE_MHB,
     .help = "Floquet multipliers: at every point where that is cheap, else at some of a curve "
             "(the others follow from near ones of one kind, or are not judged); at every "
             "point; at none"},
    {"mhb.lasting", CASE_CHOICE, "", .words = "auto always never", .fallback = "auto",
     AT(mhb.lasting), .stages = CASE_MHB, .when = CASE_IF_STABILITY,
     .help = "the motion that takes over where the wave is modulated, by integration of the whole "
             "ring: a sweep and few points a curve; every modulated point; nothing"},
    {"mhb.save", CASE_WORD_OR_NUMBERS, "Hz", 0, 1e9, true, .words = "peaks all",
     .fallback = "peaks", LISTED(mhb.save.frequency, mhb.save.n, MHB_MAX_SAVED),
     .what_at = offsetof(case_file, mhb.save.what), .stages = CASE_MHB,
     .help = "points of which the amplitude of every mode is kept, for stress and pictures of the "
             "whole blade: the peaks, all, or those at these frequencies, at most 64"},
    {"mhb.flips", CASE_SWITCH, "", .words = "mark follow", .fallback = "follow", AT(mhb.flips),
     .stages = CASE_MHB, .when = CASE_IF_STABILITY,
     .help = "where a curve loses stability by period doubling, the motion of two periods is "
             "followed from there, or not"},
    {"mhb.search.starts", CASE_AUTO, "", 0, 100000, .fallback = "auto", AT(mhb.search.starts),
     .stages = CASE_MHB,
     .help = "random starts at each frequency and order, to find curves that nothing leads to; "
             "auto: one or more of order 1 at the lowest and the highest peak of all preloads, 0: "
             "no search, 40: a good first look"},
    {"mhb.search.at", CASE_NUMBERS, "Hz", 0, 1e9, true,
     LISTED(mhb.search.at, mhb.search.n_at, MHB_MAX_SEARCH_AT), .stages = CASE_MHB,
     .when = CASE_IF_SEARCH_AT,
     .help = "frequencies at which to search, at most 64; default: six, evenly over the range"},
    {"mhb.search.orders", CASE_INTEGERS, "", 1, 16, .fallback = "[1, 2, 3]",
     LISTED(mhb.search.order, mhb.search.n_orders, MHB_MAX_SEARCH_ORDERS), .stages = CASE_MHB,
     .when = CASE_IF_SEARCH,
     .help = "orders searched for, at most 8: 1 repeats like the main curve, nu after nu times as "
             "long"},

    {"converge.tolerance", CASE_NUMBER, "", 0, 1, true, .fallback = "1 %", AT(converge_tolerance),
     .stages = CASE_CONVERGE,
     .help = "what `shroudhb converge` judges by: error of the peak, its frequency and the whole "
             "curve, relative"},
    {"converge.output", CASE_WORD, "", AT(converge_output), .stages = CASE_CONVERGE,
     .when = CASE_IF_OUTPUT,
     .help = "the motion it looks at: a probe's name, or contact; default: the first probe, else "
             "the first contact"},
    {"converge.n0", CASE_INTERVAL, "N", -1e12, 1e12, .fallback = "[-1e12, 1e12]", AT(converge_n0),
     .stages = CASE_CONVERGE,
     .help = "the preloads it looks at: those of contact.n0 in this range"},
    {"converge.seconds", CASE_NUMBER, "s", 0, 1e6, true, .fallback = "60 s", AT(converge_seconds),
     .stages = CASE_CONVERGE,
     .help = "its ladder of harmonics ends before a rung whose balance would take longer, but has "
             "two at least, and the case's own"},

    {"integrate.frequencies", CASE_POINTS, "Hz", 0, 1e9, true, .fallback = "21",
     AT(integrate.frequency), .stages = CASE_INTEGRATE,
     .help = "shroudhb integrate: number of points over mhb.frequency, or a list of frequencies"},
    {"integrate.start", CASE_CHOICE, "", .words = "balance rest state", .fallback = "balance",
     AT(integrate.start), .stages = CASE_INTEGRATE,
     .help = "each point from the stable solutions of NAME.response.h5, from rest, or from the "
             "state of the frequency before"},
    {"integrate.direction", CASE_CHOICE, "", .words = "up down both", .fallback = "both",
     AT(integrate.direction), .stages = CASE_INTEGRATE, .when = CASE_IF_SWEEP,
     .help = "of a sweep with start: state"},
    {"integrate.steps", CASE_INTEGER, "", 8, 4096, .fallback = "48", AT(integrate.steps),
     .stages = CASE_INTEGRATE,
     .help = "steps a period to begin with; doubled until two runs agree within tolerance"},
    {"integrate.tolerance", CASE_NUMBER, "", 1e-10, 0.1, .fallback = "1e-5",
     AT(integrate.tolerance), .stages = CASE_INTEGRATE,
     .help = "relative error of the periodic motion"},
    {"integrate.periods", CASE_INTEGER, "", 10, 100000000, .fallback = "5000",
     AT(integrate.max_periods), .stages = CASE_INTEGRATE,
     .help = "most periods to wait for a motion to repeat; then it counts as not periodic"},
    {"integrate.harmonics", CASE_AUTO, "", 1, MOST_HARMONICS, .fallback = "auto",
     AT(integrate.harmonics), .stages = CASE_INTEGRATE,
     .help = "harmonics kept of the motion; auto: as many as the balance has"},
};
/* clang-format on */

case_keys case_key_table(void) {
  return (case_keys){COUNT(table), table};
}

"""The case of a small blade, meshed and solved in a second; SIZE is its mesh size."""
BLADE = '''name: blade
mesh:
  blade:
    root: {length: 50 mm, width: 26 mm, height: 14 mm}
    sections:
      - {radius: 300 mm, chord: 42 mm, thickness: 6.5 mm, camber: 7 mm, twist: -12 deg}
      - {radius: 460 mm, chord: 35 mm, thickness: 3.2 mm, camber: 3 mm, twist: -38 deg}
    shroud: {length: 36 mm, thickness: 6 mm, contact: 18 mm}
    size: SIZE
rotor: {blades: 60, axis: x}
material: {E: 205 GPa, nu: 0.3, rho: 7850}
modal: {modes: 3, damping: 0.003}
excitation: {engine_order: 56, pressure: 2 kPa}
probe: {tip: [0 mm, 0 mm, 466 mm]}
contact: {to: neighbour, psi: 30 deg, mu: 0.3, ku: 1 MN/m, kv: 1.5 MN/m, n0: [20 N]}
mhb: {frequency: [90 Hz, 200 Hz], harmonics: 3}
'''

// A blade of a sector of 9 degrees with a tip shroud and a snubber half-way up, both a sector wide. Engine axis x, metres.
SetFactory("OpenCASCADE");

sector = 2 * Pi / 40;

// Root block and airfoil: a plate, twisted and tapered from 10 to 5 mm.
Box(1) = {-0.032, -0.013, 0.240, 0.064, 0.026, 0.015};

radius() = {0.250, 0.300, 0.350, 0.400, 0.444};
chord()  = {0.054, 0.051, 0.048, 0.045, 0.043};
thick()  = {0.0100, 0.0088, 0.0076, 0.0062, 0.0050};
twist()  = {-8, -15, -22, -29, -35};
For i In {0 : 4}
  p = newp;
  Point(p)     = {-chord(i) / 2, -thick(i) / 2, radius(i)};
  Point(p + 1) = {chord(i) / 2, -thick(i) / 2, radius(i)};
  Point(p + 2) = {chord(i) / 2, thick(i) / 2, radius(i)};
  Point(p + 3) = {-chord(i) / 2, thick(i) / 2, radius(i)};
  c = newc;
  Line(c)     = {p, p + 1};
  Line(c + 1) = {p + 1, p + 2};
  Line(c + 2) = {p + 2, p + 3};
  Line(c + 3) = {p + 3, p};
  Rotate{{0, 0, 1}, {0, 0, 0}, twist(i) * Pi / 180}{ Curve{c : c + 3}; }
  Curve Loop(100 + i) = {c, c + 1, c + 2, c + 3};
EndFor
ThruSections(2) = {100, 101, 102, 103, 104};

// Snubber and shroud: rectangles turned by the sector about the engine axis.
Rectangle(1001) = {-0.012, 0.343, 0, 0.024, 0.006};
Rectangle(1002) = {-0.021, 0.440, 0, 0.042, 0.007};
Rotate{{1, 0, 0}, {0, 0, 0}, Pi / 2 - sector / 2}{ Surface{1001, 1002}; }
snubber() = Extrude{{1, 0, 0}, {0, 0, 0}, sector}{ Surface{1001}; };
shroud()  = Extrude{{1, 0, 0}, {0, 0, 0}, sector}{ Surface{1002}; };
blade() = BooleanUnion{ Volume{1}; Delete; }{ Volume{2, snubber(1), shroud(1)}; Delete; };

// Faces in the planes of the sector's sides, and the foot.
e = 1e-4;
s = Sin(sector / 2);
Physical Volume("blade") = blade();
Physical Surface("root") = Surface In BoundingBox{-1, -1, 0.240 - e, 1, 1, 0.240 + e};
Physical Surface("shroud_a")  = Surface In BoundingBox{-1, -0.447 * s - e, 0.43, 1, -0.440 * s + e, 0.46};
Physical Surface("shroud_b")  = Surface In BoundingBox{-1, 0.440 * s - e, 0.43, 1, 0.447 * s + e, 0.46};
Physical Surface("snubber_a") = Surface In BoundingBox{-1, -0.349 * s - e, 0.33, 1, -0.343 * s + e, 0.36};
Physical Surface("snubber_b") = Surface In BoundingBox{-1, 0.343 * s - e, 0.33, 1, 0.349 * s + e, 0.36};

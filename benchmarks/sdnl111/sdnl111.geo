// Two bars, 1 m long and 2 cm high, with a gap of 10 um between them: cells of 1/400 m along them.
// gmsh sdnl111.geo -2 -format msh41 -o sdnl111.msh        (2005 nodes)
DefineConstant[ along = 400 ];
DefineConstant[ across = 2 ];
length = 1;
height = 0.02;
gap = 1e-5;
Macro Bar // from x = start; its first point, curve and surface have the number first
  Point(first) = {start, 0, 0};
  Point(first + 1) = {start + length, 0, 0};
  Point(first + 2) = {start + length, height, 0};
  Point(first + 3) = {start, height, 0};
  For i In {0 : 3}
    Line(first + i) = {first + i, first + (i + 1) % 4};
  EndFor
  Curve Loop(first) = {first : first + 3};
  Plane Surface(first) = {first};
  Transfinite Curve {first, first + 2} = along + 1;
  Transfinite Curve {first + 1, first + 3} = cells + 1;
  Transfinite Surface {first};
  Recombine Surface {first};
Return
start = 0; first = 1; cells = across;
Call Bar;
start = -gap - length; first = 11; cells = across / 2;
Call Bar;
Physical Surface("moving") = {1};
Physical Surface("clamped") = {11};
Physical Curve("moving-end") = {4};
Physical Curve("clamped-end") = {12};
Physical Curve("held") = {14};
Physical Curve("sides") = {1, 3, 11, 13};

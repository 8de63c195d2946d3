// Four wedges on an incline of 1 : 10 through the origin, one behind the other: 4 m long, their tops horizontal, 1 m high on
// the left and 0.6 m on the right; cells of 0.2 m.
// gmsh wedges.geo -2 -format msh41 -o wedges.msh        (504 nodes)
slope = 0.1;
length = 4;
height = 1;
DefineConstant[ size = 0.2 ];
along = length / size;
up = height / size;
first = 0;
For i In {0 : 3}
  x = 6 * i;
  y = slope * x;
  h = height / up;
  p = newp;
  Point(p) = {x, y, 0};
  Point(p + 1) = {x + length, y + slope * length, 0};
  Point(p + 2) = {x + length, y + height, 0};
  Point(p + 3) = {x, y + height, 0};
  Point(p + 4) = {x, y + h, 0};
  c = newc;
  Line(c) = {p, p + 1};
  Line(c + 1) = {p + 1, p + 2};
  Line(c + 2) = {p + 2, p + 3};
  Line(c + 3) = {p + 3, p + 4};
  Line(c + 4) = {p + 4, p};
  Curve Loop(i + 1) = {c, c + 1, c + 2, c + 3, c + 4};
  Plane Surface(i + 1) = {i + 1};
  Transfinite Curve {c, c + 2} = along + 1;
  Transfinite Curve {c + 1} = up + 1;
  Transfinite Curve {c + 3} = up;
  Transfinite Curve {c + 4} = 2;
  Transfinite Surface {i + 1} = {p, p + 1, p + 2, p + 3};
  Recombine Surface {i + 1};
  Physical Surface(Sprintf("wedge-%g", i)) = {i + 1};
  Physical Curve(Sprintf("base-%g", i)) = {c};
  Physical Curve(Sprintf("left-%g", i)) = {c + 3, c + 4};
  Physical Curve(Sprintf("pushed-%g", i)) = {c + 3}; // above the lowest cell: no node of it is on the incline
EndFor

// A slab, 2 long and 0.5 high, in squares. gmsh -2 slab.geo
Point(1) = {0, 0, 0};
line[] = Extrude {2, 0, 0} { Point{1}; Layers{50}; };
face[] = Extrude {0, 0.5, 0} { Line{line[1]}; Layers{12}; Recombine; };
Physical Surface("slab") = {face[1]};
Physical Curve("foot") = {line[1]};
Physical Curve("top") = {face[0]};

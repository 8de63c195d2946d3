// A parallelepiped in hexahedra.
Point(1) = {0.1, 0.2, 0.05};
l[] = Extrude {1.2, 0.1, 0.05} { Point{1}; Layers{2}; };
s[] = Extrude {0.1, 1.1, 0.02} { Curve{l[1]}; Layers{1}; Recombine; };
v[] = Extrude {0.05, 0.1, 0.9} { Surface{s[1]}; Layers{2}; Recombine; };
Physical Volume("body") = {v[1]};
Physical Surface("bottom") = {s[1]};
Physical Surface("top") = {v[0]};

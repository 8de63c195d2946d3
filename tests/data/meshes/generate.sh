#!/usr/bin/env bash
# Makes the meshes of this folder with the gmsh program (4.8.4 made those committed): NAME_oORDER_DIALECT.msh.
set -euo pipefail
cd "$(dirname "$0")"
make_mesh() {  # name order
  for dialect in msh22 msh41; do
    gmsh "$1.geo" -3 -order "$2" -format "$dialect" -v 1 -o "$1_o$2_${dialect}_ascii.msh"
    gmsh "$1.geo" -3 -order "$2" -format "$dialect" -bin -v 1 -o "$1_o$2_${dialect}_binary.msh"
  done
}
for order in 1 2; do
  for name in triangle quadrilateral tetrahedron hexahedron mixed; do make_mesh "$name" "$order"; done
done
make_mesh disc 2
gmsh triangle.geo -3 -order 3 -format msh41 -v 1 -o third_order.msh
gmsh hexahedron.geo -3 -order 2 -setnumber Mesh.SecondOrderIncomplete 1 -format msh22 -v 1 -o serendipity.msh
gmsh triangle.geo -3 -format msh41 -save_parametric -v 1 -o parametric_ascii.msh
gmsh triangle.geo -3 -format msh41 -save_parametric -bin -v 1 -o parametric_binary.msh
gmsh tetrahedron.geo -3 -format msh41 -part 2 -v 1 -o partitioned.msh

#include "support/thrown_body.hpp"

#include "support/case_run.hpp"

namespace ricochet::test_support {

std::vector<ThrownBody> thrown_bodies() {
  const std::string disc = "Disk(1)={0,1.02,0,1}; Physical Surface(\"body\")={1}; Physical Curve(\"contact\")={1};";
  const std::string ball = "Sphere(1)={0,0,1.02,1}; Physical Volume(\"body\")={1}; Physical Surface(\"contact\")={1};";
  return {{"disc of triangles", 2, 1, mesh_geometry("disc", disc, 0.3, 1)},
          {"disc of quadrilaterals", 2, 1, mesh_geometry("quads", disc + " Recombine Surface{1};", 0.3, 1)},
          {"curved disc of degree 2", 2, 2, mesh_geometry("disc2", disc, 0.5, 2)},
          {"ball of tetrahedra", 3, 1, mesh_geometry("ball", ball, 0.45, 1)},
          {"curved ball of degree 2", 3, 2, mesh_geometry("ball2", ball, 0.7, 2)}};
}

std::string thrown_case(const ThrownBody& body, const std::string& mass, const std::string& time,
                        const std::string& contact, const std::string& obstacle) {
  const bool flat = body.dimension == 2;
  return "[mesh]\nfile = \"" + body.mesh + "\"\ndegree = " + std::to_string(body.degree) +
         "\n[[material]]\ngroup = \"body\"\ndensity = 1.0\nlambda = 30.0\nmu = 20.0\n"
         "[obstacle.plane]\ntype = \"plane\"\n" +
         (flat ? "point = [0.0, 0.0]\nnormal = [0.1, 1.0]\n"
               : "point = [0.0, 0.0, 0.0]\nnormal = [0.1, -0.05, 1.0]\n") +
         obstacle + "[[contact]]\ngroup = \"contact\"\nobstacle = \"plane\"\n" + contact + "[load]\n" +
         (flat ? "gravity = [0.3, -1.0]\n[initial]\nvelocity = [\"0.1-0.2*y\", \"-0.5+0.2*x\"]\n"
               : "gravity = [0.3, 0.1, -1.0]\n[initial]\nvelocity = [\"0.1-0.2*z\", \"0.1\", \"-0.5+0.2*x\"]\n") +
         "[mass]\ntype = \"" + mass + "\"\n[time]\n" + time + "step = 0.01\nend = 1.5\n";
}

}  // namespace ricochet::test_support

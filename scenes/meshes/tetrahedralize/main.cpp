// impinge-tetrahedralize SURFACE.off VOLUME.msh --max-size METRES [--min-angle DEGREES]
//
// Fills a closed triangle surface with tetrahedra by Delaunay refinement (CGAL Mesh_3), improves the worst of them, and
// writes Gmsh 2.2. The surface may intersect itself; its edges and corners come out rounded. The answer is the same in
// each run. Exit code 0, or 2 with one message on the last line of standard error.
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Mesh_complex_3_in_triangulation_3.h>
#include <CGAL/Mesh_criteria_3.h>
#include <CGAL/Mesh_triangulation_3.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polyhedral_mesh_domain_3.h>
#include <CGAL/Random.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/make_mesh_3.h>

#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Surface = CGAL::Surface_mesh<Point>;
using Domain = CGAL::Polyhedral_mesh_domain_3<Surface, Kernel>;
using Triangulation = CGAL::Mesh_triangulation_3<Domain>::type;
using Complex = CGAL::Mesh_complex_3_in_triangulation_3<Triangulation>;
using Criteria = CGAL::Mesh_criteria_3<Triangulation>;

struct Options {
  std::string surface, volume;
  double max_size = 0.0, min_angle = 10.0;
};

double number(const char* name, const char* text) {
  char* end = nullptr;
  const double value = std::strtod(text, &end);
  if (end == text || *end != '\0' || !std::isfinite(value))
    throw std::runtime_error(std::string(name) + " is no number");
  return value;
}

Options parse(int count, char** words) {
  Options options;
  std::vector<std::string> files;
  for (int i = 1; i < count; ++i) {
    const bool last = i + 1 == count;
    if (std::strcmp(words[i], "--max-size") == 0 && !last)
      options.max_size = number("--max-size", words[++i]);
    else if (std::strcmp(words[i], "--min-angle") == 0 && !last)
      options.min_angle = number("--min-angle", words[++i]);
    else
      files.emplace_back(words[i]);
  }
  if (files.size() != 2 || !(options.max_size > 0.0) || options.min_angle < 0.0 || options.min_angle > 20.0)
    throw std::runtime_error(
        "usage: impinge-tetrahedralize SURFACE.off VOLUME.msh --max-size METRES [--min-angle 0...20]");
  options.surface = files[0];
  options.volume = files[1];
  return options;
}

Surface read_off(const std::string& path) {
  std::ifstream in(path);
  std::string head;
  std::size_t vertices = 0, faces = 0, edges = 0;
  if (!(in >> head >> vertices >> faces >> edges) || head != "OFF") throw std::runtime_error(path + " is no OFF file");
  std::vector<Point> points;
  std::vector<std::vector<std::size_t>> polygons;
  double x = 0.0, y = 0.0, z = 0.0;
  for (std::size_t i = 0; i < vertices && in >> x >> y >> z; ++i) points.emplace_back(x, y, z);
  for (std::size_t i = 0; i < faces; ++i) {
    std::size_t corners = 0, a = 0, b = 0, c = 0;
    if (!(in >> corners >> a >> b >> c) || corners != 3 || std::max({a, b, c}) >= points.size())
      throw std::runtime_error(path + " ends early or holds more than triangles");
    polygons.push_back({a, b, c});
  }
  // vertices where two sheets touch are taken apart
  CGAL::Polygon_mesh_processing::orient_polygon_soup(points, polygons);
  Surface surface;
  CGAL::Polygon_mesh_processing::polygon_soup_to_polygon_mesh(points, polygons, surface);
  if (surface.number_of_faces() == 0 || !CGAL::is_closed(surface))
    throw std::runtime_error(path + " is not a closed surface");
  return surface;
}

void write_msh(const std::string& path, const Complex& complex) {
  std::FILE* out = std::fopen(path.c_str(), "w");
  if (out == nullptr) throw std::runtime_error(path + " can't be written");
  // only what tetrahedra use, numbered in order of first use
  std::map<Triangulation::Vertex_handle, std::size_t> number;
  std::vector<Triangulation::Vertex_handle> vertices;
  std::vector<std::array<std::size_t, 4>> tets;
  for (auto cell = complex.cells_in_complex_begin(); cell != complex.cells_in_complex_end(); ++cell) {
    std::array<std::size_t, 4> tet;
    for (int k = 0; k < 4; ++k) {
      const auto [at, is_new] = number.try_emplace(cell->vertex(k), vertices.size() + 1);
      if (is_new) vertices.push_back(cell->vertex(k));
      tet[k] = at->second;
    }
    tets.push_back(tet);
  }
  std::fprintf(out, "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n%zu\n", vertices.size());
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const auto& p = vertices[i]->point();
    std::fprintf(out, "%zu %.17g %.17g %.17g\n", i + 1, p.x(), p.y(), p.z());
  }
  std::fprintf(out, "$EndNodes\n$Elements\n%zu\n", tets.size());
  for (std::size_t i = 0; i < tets.size(); ++i)
    std::fprintf(out, "%zu 4 2 1 1 %zu %zu %zu %zu\n", i + 1, tets[i][0], tets[i][1], tets[i][2], tets[i][3]);
  std::fprintf(out, "$EndElements\n");
  if (std::ferror(out) != 0 || std::fclose(out) != 0) throw std::runtime_error(path + " can't be written to its end");
  if (tets.empty()) throw std::runtime_error("no tetrahedron fits: --max-size is too large for this surface");
}

}  // namespace

int main(int count, char** words) {
  namespace params = CGAL::parameters;
  try {
    const Options options = parse(count, words);
    const Surface surface = read_off(options.surface);
    CGAL::get_default_random() = CGAL::Random(1);  // its own seed is the time
    CGAL::Random random(1);
    const Domain domain(surface, &random);
    // CGAL bounds circumscribed spheres; of a regular tetrahedron that radius is 0.61 edges
    const double radius = 0.61 * options.max_size;
    const Criteria criteria(params::facet_angle = 25.0, params::facet_size = radius,
                            params::facet_distance = 0.1 * options.max_size, params::cell_radius_edge_ratio = 2.0,
                            params::cell_size = radius);
    Complex complex = CGAL::make_mesh_3<Complex>(domain, criteria, params::no_perturb(), params::no_exude());
    if (options.min_angle > 0.0) {
      CGAL::perturb_mesh_3(complex, domain, params::sliver_bound = options.min_angle);
      CGAL::exude_mesh_3(complex, params::sliver_bound = options.min_angle);
    }
    write_msh(options.volume, complex);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
}

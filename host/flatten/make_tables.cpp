// SPDX-License-Identifier: Apache-2.0
// Build-time program: integrates the directional albedos of bsdf/energy.h and bsdf/dielectric.h and writes them as a list of floats for tables.cpp.
// The functions integrated are the kernels' own. A fixed quadrature and one thread, so that the list is the same wherever it is built.
#include <algorithm>
#include <array>
#include <cstdio>
#include <vector>

#include "bsdf/dielectric.h"
#include "shared/tables.h"

namespace {

using namespace sunstone::kernel;

constexpr int split_nodes = SUN_ENERGY_N, glass_nodes = SUN_GLASS_N;

// What one visible normal of a direction does: quadrature weight, and what is left of light that leaves along a given cosine, G2 / G1.
struct Facet {
  vec3 h;
  float cosine_oh;
  double weight, mirrored;  // mirrored: the weight with the masking of the mirrored direction; 0 below the surface
};

struct View {
  float cosine, alpha, root, masking;
  vec3 wo;
  std::vector<Facet> facets;
  // Midpoints in (u0, u1). Half the azimuth is enough; 1 - u1 = v^3 puts rings where GGX has its long tail.
  View(float cosine_o, float alpha_, int azimuths, int rings) : cosine(std::max(cosine_o, SUN_MIN_COSINE)), alpha(alpha_) {
    if (smooth()) return;
    wo = make_vec3(sqrt_or_zero((1.0f - cosine) * (1.0f + cosine)), 0.0f, cosine);
    root = smith_root(cosine, alpha);
    masking = smith_masking(cosine, root);
    double norm = 0;
    for (int ring = 0; ring < rings; ring++) {
      const float v = (float(ring) + 0.5f) / float(rings);
      norm += double(v) * double(v) * azimuths;
      for (int azimuth = 0; azimuth < azimuths; azimuth++) {
        Facet f;
        f.h = sample_visible_normal(wo, alpha, (float(azimuth) + 0.5f) / float(2 * azimuths), 1.0f - v * v * v);
        f.cosine_oh = clamp_real(dot3(wo, f.h), 0.0f, 1.0f);
        f.weight = double(v) * double(v);
        f.mirrored = f.weight * unmasked(mirror_about(wo, f.h).z);
        facets.push_back(f);
      }
    }
    for (Facet &f : facets) f.weight /= norm, f.mirrored /= norm;
  }
  bool smooth() const { return alpha < SUN_ALPHA_SMOOTH; }
  double unmasked(float cosine_i) const {
    if (!(cosine_i > 0.0f)) return 0;
    const float c = std::clamp(cosine_i, SUN_MIN_COSINE, 1.0f);
    return smith_visibility(cosine, root, c, smith_root(c, alpha)) * c / masking;
  }
};

struct Albedo {
  double all = 0;      // F = 1
  double grazing = 0;  // F = (1 - o.h)^5
};

Albedo reflected(const View &view) {
  if (view.smooth()) return {1.0, schlick_weight(view.cosine)};
  Albedo sum;
  for (const Facet &f : view.facets) {
    sum.all += f.mirrored;
    sum.grazing += f.mirrored * schlick_weight(f.cosine_oh);
  }
  return sum;
}

double reflected_and_refracted(const View &view, float eta) {
  if (view.smooth()) return 1.0;
  double sum = 0;
  const float inverse = 1.0f / eta;
  for (const Facet &f : view.facets) {
    const float cosine_far = refracted_cosine(f.cosine_oh, inverse);
    const double reflectance = fresnel_dielectric(f.cosine_oh, eta, cosine_far);
    sum += reflectance * f.mirrored;
    if (reflectance < 1.0) sum += (1.0 - reflectance) * f.weight * view.unmasked(-refract_about(view.wo, f.h, inverse, f.cosine_oh, cosine_far).z);
  }
  return sum;
}

// The axes of kernels/bsdf/energy.h: linear in the square root.
float of_axis(int half_steps, int nodes) {
  const double x = 0.5 * half_steps / (nodes - 1);
  return float(x * x);
}

// A function over a grid of D axes (axis 0 fastest), known at the nodes and half-way between them.
template <int D> class Grid {
 public:
  using Place = std::array<int, D>;  // in half steps
  explicit Grid(int nodes) : side_(2 * nodes - 1), nodes_(nodes), fine_(power(side_)) {}
  double &fine(const Place &at) { return fine_[index(at, side_)]; }

  // Nodes lifted until the interpolant is nowhere below the function: what a lobe gives back must not exceed what was lost.
  std::vector<double> lifted() const {
    std::vector<double> nodes(power(nodes_)), result;
    for_places(nodes_, [&](const Place &at) {
      Place doubled;
      for (std::size_t d = 0; d < D; d++) doubled[d] = 2 * at[d];
      nodes[index(at, nodes_)] = fine_[index(doubled, side_)];
    });
    result = nodes;
    for_places(side_, [&](const Place &at) {
      double interpolant = 0;
      for (int corner = 0; corner < 1 << D; corner++) interpolant += nodes[near(at, corner)] / (1 << D);
      const double missing = fine_[index(at, side_)] - interpolant;
      for (int corner = 0; corner < 1 << D && missing > 0; corner++) {
        const std::size_t node = near(at, corner);
        result[node] = std::max(result[node], nodes[node] + missing);
      }
    });
    return result;
  }

 private:
  static std::size_t power(int n) {
    std::size_t product = 1;
    for (int d = 0; d < D; d++) product *= std::size_t(n);
    return product;
  }
  static std::size_t index(const Place &at, int n) {
    std::size_t i = 0;
    for (std::size_t d = D; d-- > 0;) i = i * std::size_t(n) + std::size_t(at[d]);
    return i;
  }
  template <class Visit> static void for_places(int n, Visit visit) {
    for (std::size_t i = 0; i < power(n); i++) {
      Place at;
      std::size_t rest = i;
      for (int &x : at) x = int(rest % std::size_t(n)), rest /= std::size_t(n);
      visit(at);
    }
  }
  // A node next to a place: on an axis where the place is a node, both corners are that node.
  std::size_t near(const Place &at, int corner) const {
    Place node;
    for (std::size_t d = 0; d < D; d++) node[d] = (at[d] + (corner >> d & 1)) / 2;
    return index(node, nodes_);
  }
  int side_, nodes_;
  std::vector<double> fine_;
};

// Mean over the cosine-weighted hemisphere of one row, linear in x = sqrt(cos): the integral of 4 x^3 E(x), exactly.
double mean_of_row(const double *row, int nodes) {
  double sum = 0;
  const double h = 1.0 / (nodes - 1);
  for (int i = 0; i + 1 < nodes; i++) {
    const double a = i * h, b = a + h, slope = (row[i + 1] - row[i]) / h, constant = row[i] - slope * a;
    sum += constant * (b * b * b * b - a * a * a * a) + slope * 0.8 * (b * b * b * b * b - a * a * a * a * a);
  }
  return sum;
}

void make_split(std::vector<float> &table) {
  Grid<2> all_grid(split_nodes), grazing_grid(split_nodes);
  for (int j = 0; j < 2 * split_nodes - 1; j++)
    for (int i = 0; i < 2 * split_nodes - 1; i++) {
      const Albedo albedo = reflected(View(of_axis(i, split_nodes), of_axis(j, split_nodes), 32, 96));
      all_grid.fine({i, j}) = albedo.all;
      grazing_grid.fine({i, j}) = albedo.grazing;
    }
  std::vector<double> all = all_grid.lifted(), grazing = grazing_grid.lifted();
  for (std::size_t i = 0; i < all.size(); i++) {
    all[i] = std::min(all[i], 1.0);
    grazing[i] = std::min(grazing[i], all[i]);
    table[SUN_TABLE_SPLIT_A + i] = float(all[i] - grazing[i]);
    table[SUN_TABLE_SPLIT_B + i] = float(grazing[i]);
  }
  for (int j = 0; j < split_nodes; j++) {
    const std::size_t row = std::size_t(j * split_nodes);
    const double e = mean_of_row(&all[row], split_nodes), b = mean_of_row(&grazing[row], split_nodes);
    table[std::size_t(SUN_TABLE_SPLIT_A_MEAN + j)] = float(e - b);
    table[std::size_t(SUN_TABLE_SPLIT_B_MEAN + j)] = float(b);
  }
}

void make_glass(std::vector<float> &table) {
  std::array<Grid<3>, 2> grids{Grid<3>(glass_nodes), Grid<3>(glass_nodes)};
  for (int j = 0; j < 2 * glass_nodes - 1; j++)
    for (int i = 0; i < 2 * glass_nodes - 1; i++) {
      const View view(of_axis(i, glass_nodes), of_axis(j, glass_nodes), 24, 64);
      for (int e = 0; e < 2 * glass_nodes - 1; e++) {
        const float r = std::clamp(of_axis(e, glass_nodes), 1e-3f, 0.9995f);  // an equal and an infinite ior are limits
        const float n = (1.0f + r) / (1.0f - r);
        grids[0].fine({i, j, e}) = reflected_and_refracted(view, n);
        grids[1].fine({i, j, e}) = reflected_and_refracted(view, 1.0f / n);
      }
    }
  for (std::size_t side = 0; side < 2; side++) {
    std::vector<double> albedo = grids[side].lifted();
    for (std::size_t i = 0; i < albedo.size(); i++) {
      albedo[i] = std::min(albedo[i], 1.0);
      table[SUN_TABLE_GLASS + side * albedo.size() + i] = float(albedo[i]);
    }
    constexpr std::size_t rows = glass_nodes * glass_nodes;
    for (std::size_t row = 0; row < rows; row++)
      table[SUN_TABLE_GLASS_MEAN + side * rows + row] = float(mean_of_row(&albedo[row * glass_nodes], glass_nodes));
  }
}

}  // namespace

int main(int count, char **arguments) {
  if (count != 2) return std::fputs("make_tables FILE\n", stderr), 2;
  std::vector<float> table(SUN_TABLE_FILTER);
  make_split(table);
  make_glass(table);
  std::FILE *file = std::fopen(arguments[1], "w");
  if (!file) return std::perror(arguments[1]), 1;
  for (std::size_t i = SUN_TABLE_SPLIT_A; i < table.size(); i++) std::fprintf(file, "%af,%c", double(table[i]), i % 16 == 15 ? '\n' : ' ');
  return std::fclose(file) == 0 ? 0 : (std::perror(arguments[1]), 1);
}

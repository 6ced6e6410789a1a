// SPDX-License-Identifier: Apache-2.0
// Path tracing with an area light, found by chance: the picture at growing numbers of samples, and how its error falls.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "learn/figure.h"
#include "learn/fit.h"
#include "learn/pictures.h"

namespace sunstone {

namespace {

constexpr unsigned depth = 5;

struct Curve {
  std::vector<double> samples, rmse, relmse;
  Line fit;  // of the powers of two
  std::uint64_t last = 0;
};

// Error against `reference` after each of `counts`. Films add, so sample n is rendered once and stays: the curve costs what its last point costs.
Curve measure(Easel &easel, Renderer &renderer, const std::set<std::uint64_t> &counts, const Image &reference, double share, const std::string &name,
              const std::function<void(std::uint64_t, const Film &)> &show) {
  Curve curve;
  std::vector<double> fitted_n, fitted_rmse;
  for (const std::uint64_t n : counts) {
    easel.studio.piece(share * static_cast<double>(n - curve.last) / static_cast<double>(*counts.rbegin()), name);
    easel.studio.render(renderer, {curve.last, n});
    const Comparison error = load_content().compare_images(beauty_of(renderer.film()), reference);
    curve.samples.push_back(static_cast<double>(n));
    curve.rmse.push_back(error.rmse);
    curve.relmse.push_back(error.relmse);
    curve.last = n;
    if ((n & (n - 1)) == 0) {
      fitted_n.push_back(static_cast<double>(n));
      fitted_rmse.push_back(error.rmse);
    }
    show(n, renderer.film());
  }
  curve.fit = fit_power(fitted_n, fitted_rmse);
  return curve;
}

Series fitted(const std::string &name, const Curve &curve) {
  Series s{name, {}, {}, false, true};
  for (const double n : {curve.samples.front(), curve.samples.back()}) {
    s.x.push_back(n);
    s.y.push_back(std::exp(curve.fit.intercept) * std::pow(n, curve.fit.slope));
  }
  return s;
}

std::string slope_of(const Curve &curve) { return fmt::format("{:.3f} ± {:.3f}", curve.fit.slope, curve.fit.slope_error); }

// The RMSE of a picture against its own expectation, from the films of several seeds.
double own_error(const std::vector<Film> &films, const Image &mean) {
  double squares = 0;
  const std::vector<float> &m = std::get<std::vector<float>>(mean.pixels);
  for (const Film &film : films) {
    const std::vector<float> x = film_beauty(film);
    for (std::size_t i = 0; i < x.size(); i++) squares += (static_cast<double>(x[i]) - m[i]) * (static_cast<double>(x[i]) - m[i]) / static_cast<double>(x.size());
  }
  const double n = static_cast<double>(films.size());
  return std::sqrt(squares / (n - 1) / n);
}

}  // namespace

std::string draw_convergence(Easel &easel) {
  const int side = easel.size(40, 8);
  const std::set<std::uint64_t> shown = easel.quick ? std::set<std::uint64_t>{1, 16, 64} : std::set<std::uint64_t>{1, 100, 1024, 10000, 100000};
  std::set<std::uint64_t> counts = shown;
  for (std::uint64_t n = 1; n <= *shown.rbegin(); n *= 2) counts.insert(n);
  constexpr std::uint32_t seeds = 4, first_seed = 1000;
  const std::uint64_t reference_samples = easel.size<std::uint64_t>(16384, 256);

  // The reference: another estimator of the same integral with far less noise, from seeds that no curve uses.
  Shot shot{"cornell/cornell.gltf", "", figure_settings(side, side, "path", depth)};
  std::vector<Film> references;
  std::vector<float> sum(static_cast<std::size_t>(side) * static_cast<std::size_t>(side) * 3);
  for (std::uint32_t seed = 0; seed < seeds; seed++) {
    shot.settings.seed = first_seed + seed;
    const auto renderer = easel.studio.renderer(shot);
    easel.studio.piece(0.2 / seeds, fmt::format("the reference, {} of {}", seed + 1, seeds));
    easel.studio.render(*renderer, {0, reference_samples});
    references.push_back(renderer->film());
    const std::vector<float> beauty = film_beauty(renderer->film());
    for (std::size_t i = 0; i < sum.size(); i++) sum[i] += beauty[i] / static_cast<float>(seeds);
  }
  const Image reference{"reference", side, side, 3, sum};
  const double reference_error = own_error(references, reference);
  write_png(easel.file("convergence-reference.png"), film_of(side, side, sum));

  std::vector<Picture> row;
  std::vector<Curve> curves;
  shot.settings.integrator = "pure";
  shot.settings.seed = 0;
  for (const bool independent : {true, false}) {
    shot.settings.independent = independent;
    const auto renderer = easel.studio.renderer(shot);
    curves.push_back(measure(easel, *renderer, counts, reference, 0.4, independent ? "independent samples" : "Sobol' samples", [&](std::uint64_t n, const Film &film) {
      if (!independent || !shown.contains(n)) return;
      const std::filesystem::path file = easel.file(fmt::format("convergence-{}.png", n));
      write_png(file, film);
      row.push_back({file, show_number(static_cast<double>(n), 6) + (n == 1 ? " sample" : " samples")});
    }));
  }
  const Curve &independent = curves[0], &sobol = curves[1];
  row.push_back({easel.file("convergence-reference.png"), "the reference"});

  Table table{{"samples", "RMSE independent", "RMSE Sobol'", "relMSE independent", "relMSE Sobol'", "ratio of RMSE"}, {}};
  for (std::size_t i = 0; i < independent.samples.size(); i++)
    table.rows.push_back({fmt::format("{:.0f}", independent.samples[i]), fmt::format("{:.6g}", independent.rmse[i]), fmt::format("{:.6g}", sobol.rmse[i]), fmt::format("{:.6g}", independent.relmse[i]),
                          fmt::format("{:.6g}", sobol.relmse[i]), fmt::format("{:.2f}", independent.rmse[i] / sobol.rmse[i])});
  write_csv(easel.file("convergence.csv"), table);
  Table slopes{{"sampler", "slope", "standard error", "intercept"}, {}};
  for (const auto &[name, curve] : {std::pair<const char *, const Curve &>{"independent", independent}, {"sobol", sobol}})
    slopes.rows.push_back({name, fmt::format("{:.5f}", curve.fit.slope), fmt::format("{:.5f}", curve.fit.slope_error), fmt::format("{:.5f}", curve.fit.intercept)});
  write_csv(easel.file("convergence-slopes.csv"), slopes);

  const double last_ratio = independent.rmse.back() / sobol.rmse.back(), gain = last_ratio * last_ratio;
  const std::string finding = fmt::format("Independent samples: the error falls with slope {} in log-log, where theory says −0.5. Sobol' points: {}, steeper by {:.3f}; at {} samples their error is {:.1f} times "
                                          "smaller, which {} times as many independent samples would take.",
                                          slope_of(independent), slope_of(sobol), independent.fit.slope - sobol.fit.slope, show_number(sobol.samples.back(), 6), last_ratio, show_number(gain, 2));
  Page page("From 1 to 100 000 samples", "An area light that paths have to meet by chance, and how slowly the noise goes.");
  page.text("Pure path tracing in the Cornell box: no ray is sent to the light, a path counts when it happens to hit it. With independent samples:");
  page.pictures(row);
  page.text(finding);
  page.plot(easel.keep_plot("convergence.svg", line_plot("Error by samples a pixel", {"samples a pixel", true}, {"RMSE", true},
                                                         {{"independent", independent.samples, independent.rmse},
                                                          {"Sobol' (Owen-scrambled)", sobol.samples, sobol.rmse},
                                                          fitted("slope " + show_number(independent.fit.slope, 3), independent),
                                                          fitted("slope " + show_number(sobol.fit.slope, 3), sobol)})));
  page.text("The mean of n independent samples has 1/n of one sample's variance, so its standard deviation falls as n to the power −1/2, whatever the scene: four times the work for half the noise. Nothing that "
            "improves a single sample changes that slope; it moves the line down. Points that cover the space of random numbers evenly can fall faster, where the integrand is smooth: here it has edges (the "
            "light's outline, shadows) in many dimensions, so the gain is real and stays short of the −1 or −1.5 of smooth integrands in few dimensions.");
  page.text(fmt::format("How it was measured: {0} × {0} pixels with a box filter, so pixels share no sample; depth {1}; RMSE over pixels and channels. The curve is of one render whose film is looked at on the "
                        "way: films add, so sample n is never rendered twice. Slopes are least-squares lines through the powers of two, in logarithms, with the standard error of their residuals.",
                        side, depth));
  page.text(fmt::format("The reference is not more of the same but another way to the same picture: `--integrator path`, which samples the light and weights (other tests hold both to the same expectation), {} × {} samples "
                        "a pixel. The spread of its {} seeds puts its own RMSE at {}, {:.0f} times below the smallest error on the plot{}.",
                        seeds, show_number(static_cast<double>(reference_samples), 6), seeds, show_number(reference_error, 2), std::min(independent.rmse.back(), sobol.rmse.back()) / reference_error,
                        std::min(independent.rmse.back(), sobol.rmse.back()) > 4 * reference_error ? "" : ": too near for the last points to be trusted"));
  page.table(table);
  page.command("sunstone render scenes/cornell/cornell.gltf --integrator pure --sampler independent --size 40x40 --filter box --max-depth 5 --spp 1024 -o noise.png");
  page.write(easel.file("convergence.html"));
  return finding;
}

}  // namespace sunstone

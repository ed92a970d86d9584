#include "tests/fuzz/scenario.hpp"

#include <cstdint>
#include <istream>
#include <limits>
#include <ostream>
#include <stdexcept>
#include <string>

#include "segmenter/core/parameters/engine_config.hpp"

namespace kintsugi::segmenter::fuzz {
namespace {

template <typename Fn>
void for_each_parameter(const Fn& fn) {
  for (const EngineParameter& parameter : kMapParameters) fn(parameter);
  for (const EngineParameter& parameter : kSpeedParameters) fn(parameter);
}

void write_indices(std::ostream& out, const char* name, const std::vector<PoolIndex>& indices) {
  out << name << ' ' << indices.size();
  for (const PoolIndex i : indices) out << ' ' << i;
  out << '\n';
}

template <typename Number>
Number read_number(std::istream& in, const std::string& what) {
  Number number{};
  if (!(in >> number)) throw std::runtime_error("scenario: expected " + what);
  return number;
}

std::uint8_t read_color_channel(std::istream& in) {
  const int value = read_number<int>(in, "a colour channel");
  if (value < 0 || value > UINT8_MAX) {
    throw std::runtime_error("scenario: colour channel " + std::to_string(value));
  }
  return static_cast<std::uint8_t>(value);
}

void expect_word(std::istream& in, const std::string& word) {
  std::string found;
  if (!(in >> found) || found != word) {
    throw std::runtime_error("scenario: found \"" + found + "\", expected \"" + word + "\"");
  }
}

std::vector<PoolIndex> read_indices(std::istream& in, const char* name, std::size_t pool_size) {
  expect_word(in, name);
  std::vector<PoolIndex> indices(read_number<std::size_t>(in, "a count of points"));
  for (PoolIndex& i : indices) {
    i = read_number<PoolIndex>(in, "a point");
    if (i >= pool_size) {
      throw std::runtime_error("scenario: point " + std::to_string(i) + " of " +
                               std::to_string(pool_size));
    }
  }
  return indices;
}

}  // namespace

void write_scenario(std::ostream& out, const Scenario& scenario) {
  out.precision(std::numeric_limits<double>::max_digits10);
  out << "config";
  for_each_parameter(
      [&](const EngineParameter& parameter) { out << ' ' << scenario.config.*parameter.value; });
  out << '\n';
  out << "slice_points " << scenario.slice_points << '\n';
  out << "points " << scenario.pool.size() << '\n';
  for (const CloudPoint& p : scenario.pool) {
    out << p.x << ' ' << p.y << ' ' << p.z << "  " << p.nx << ' ' << p.ny << ' ' << p.nz << "  "
        << int{p.red} << ' ' << int{p.green} << ' ' << int{p.blue} << '\n';
  }
  out << "steps " << scenario.steps.size() << '\n';
  for (const Step& step : scenario.steps) {
    write_indices(out, "remove", step.remove);
    write_indices(out, "add", step.add);
  }
}

Scenario read_scenario(std::istream& in) {
  Scenario scenario;
  expect_word(in, "config");
  for_each_parameter([&](const EngineParameter& parameter) {
    scenario.config.*parameter.value = read_number<double>(in, std::string(parameter.name));
  });
  expect_word(in, "slice_points");
  scenario.slice_points = read_number<std::size_t>(in, "the number of points in a slice");
  if (scenario.slice_points == 0) throw std::runtime_error("scenario: slice_points is 0");
  expect_word(in, "points");
  scenario.pool.resize(read_number<std::size_t>(in, "the number of points"));
  for (CloudPoint& p : scenario.pool) {
    for (float* const value : {&p.x, &p.y, &p.z, &p.nx, &p.ny, &p.nz}) {
      *value = read_number<float>(in, "a coordinate");
    }
    for (std::uint8_t* const channel : {&p.red, &p.green, &p.blue}) {
      *channel = read_color_channel(in);
    }
  }
  expect_word(in, "steps");
  scenario.steps.resize(read_number<std::size_t>(in, "the number of steps"));
  for (Step& step : scenario.steps) {
    step.remove = read_indices(in, "remove", scenario.pool.size());
    step.add = read_indices(in, "add", scenario.pool.size());
  }
  return scenario;
}

}  // namespace kintsugi::segmenter::fuzz

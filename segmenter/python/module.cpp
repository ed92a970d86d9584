// The module kintsugi._kintsugi.

#include "segmenter/python/arrays.hpp"
#include "segmenter/python/bind.hpp"
#include "segmenter/python/queries.hpp"

PYBIND11_MODULE(_kintsugi, module) {
  using namespace kintsugi::python;
  module.doc() = "The part of the package kintsugi that is written in C++.";
  module.attr("__version__") = KINTSUGI_VERSION;
  add_dtypes(module);
  add_answer(module);
  add_segmenter(module);
  add_saved_map(module);
  add_updates(module);
  add_map_client(module);
}

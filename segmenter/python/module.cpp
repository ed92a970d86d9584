// The module kintsugi._kintsugi.

#include <exception>
#include <stdexcept>
#include <utility>

#include "segmenter/python/arrays.hpp"
#include "segmenter/python/bind.hpp"
#include "segmenter/python/queries.hpp"

namespace {

namespace py = pybind11;

void raise(PyObject* type, const std::exception& error) {
  PyErr_SetObject(type, kintsugi::python::text_of(error.what()).ptr());
}

/// Errors name files; those of pybind11 itself, which have types of their own, do not.
void translate(std::exception_ptr error) {
  if (!error) return;
  try {
    std::rethrow_exception(std::move(error));
  } catch (const py::builtin_exception&) {
    throw;
  } catch (const std::invalid_argument& wrong) {
    raise(PyExc_ValueError, wrong);
  } catch (const std::runtime_error& failure) {
    raise(PyExc_RuntimeError, failure);
  }
}

}  // namespace

PYBIND11_MODULE(_kintsugi, module) {
  using namespace kintsugi::python;
  module.doc() = "The part of the package kintsugi that is written in C++.";
  module.attr("__version__") = KINTSUGI_VERSION;
  py::register_local_exception_translator(&translate);
  add_dtypes(module);
  add_answer(module);
  add_segmenter(module);
  add_saved_map(module);
  add_updates(module);
  add_map_client(module);
}

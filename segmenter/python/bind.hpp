#pragma once
// What the files of the module add to it.

#include <mutex>
#include <string>
#include <utility>

#include <pybind11/pybind11.h>

namespace kintsugi::python {

namespace py = pybind11;

void add_segmenter(py::module_& module);
void add_saved_map(py::module_& module);
void add_updates(py::module_& module);
void add_map_client(py::module_& module);

/// Text that may be no UTF-8, as names of files and of maps on the bus: such bytes are replaced.
inline py::str text_of(const std::string& text) {
  PyObject* const decoded =
      PyUnicode_DecodeUTF8(text.data(), static_cast<py::ssize_t>(text.size()), "replace");
  if (decoded == nullptr) throw py::error_already_set();
  return py::reinterpret_steal<py::str>(decoded);
}

/// A getter of such a text.
template <class Object>
auto text(std::string Object::*member) {
  return [member](const Object& object) { return text_of(object.*member); };
}

/// An object that threads of Python share. Long calls release the interpreter's lock and take this
/// one, in this order, so that no two threads use the object at a time and none waits for the
/// other.
template <class Object>
class Shared {
 public:
  explicit Shared(Object object) : object_(std::move(object)) {}

  /// Calls function(object) without the interpreter's lock: it must touch no Python object.
  template <class Function>
  auto with(Function&& function) {
    const py::gil_scoped_release released;
    const std::lock_guard lock(mutex_);
    return function(object_);
  }

 private:
  std::mutex mutex_;
  Object object_;
};

}  // namespace kintsugi::python

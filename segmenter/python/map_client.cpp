// kintsugi.MapClient, kintsugi.connect, kintsugi.open_log, kintsugi.read_log

#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "lcmtypes/base/deadline.hpp"
#include "segmenter/library/bus.hpp"
#include "segmenter/python/arrays.hpp"
#include "segmenter/python/bind.hpp"
#include "segmenter/python/queries.hpp"

namespace kintsugi::python {
namespace {

using Self = Shared<MapClient>;
using Seconds = MapClient::Seconds;

constexpr Seconds kSignalPeriod(0.1);

/// What takes long is done in steps, so that Ctrl-C is heard.
void raise_signals() {
  if (PyErr_CheckSignals() != 0) throw py::error_already_set();
}

MapChanges wait(Self& self, double timeout_s) {
  const auto end = deadline_after(Seconds(timeout_s));
  while (true) {
    const Seconds left = end - std::chrono::steady_clock::now();
    bool has_ended = false;
    MapChanges changes = self.with([&](MapClient& client) {
      MapChanges received = client.wait(std::clamp(left, Seconds(0.0), kSignalPeriod));
      has_ended = client.has_ended();
      return received;
    });
    raise_signals();
    if (!changes.is_empty() || has_ended || left <= Seconds(0.0)) return changes;
  }
}

std::unique_ptr<Self> open_log_of(const std::filesystem::path& file, const std::string& map_name,
                                  bool with_points, const std::filesystem::path& bus_key,
                                  bool trust_log) {
  const py::gil_scoped_release released;  // with a key, all of the log is verified
  return std::make_unique<Self>(MapClient::open_log(file, {.map_name = map_name,
                                                           .with_points = with_points,
                                                           .bus_key = bus_key.string(),
                                                           .trust_log = trust_log}));
}

std::unique_ptr<Self> read_log_of(const std::filesystem::path& file, const std::string& map_name,
                                  bool with_points, const std::filesystem::path& bus_key,
                                  bool trust_log) {
  auto self = open_log_of(file, map_name, with_points, bus_key, trust_log);
  while (!self->with([](MapClient& client) {
    const auto end = deadline_after(kSignalPeriod);
    while (!client.has_ended() && std::chrono::steady_clock::now() < end) {
      client.wait(kSignalPeriod);
    }
    return client.has_ended();
  })) {
    raise_signals();
  }
  return self;
}

SegmentAnswer query(Self& self, double timeout_s, const py::kwargs& keywords) {
  const SegmentQuery asked = query_of(keywords);
  return self.with([&](MapClient& client) {
    return client.ask(asked, Seconds(timeout_s), [] {
      const py::gil_scoped_acquire acquired;
      raise_signals();
    });
  });
}

/// A getter without arguments that may have to wait for another thread.
template <class Function>
auto getter(Function function) {
  return [function](Self& self) { return self.with(function); };
}

/// Of a text, which may name a file or a map.
auto text_getter(std::string (MapClient::*function)() const) {
  return [function](Self& self) {
    return text_of(self.with([&](MapClient& client) { return (client.*function)(); }));
  };
}

constexpr char kClassHelp[] =
    R"(One map as its mapper and segmenter publish it, from the bus or a log.

connect(), open_log() and read_log() make one. It has the pieces (slices) with their points where all
corrections have put them, the segment of each point, every segment, and the camera. On the bus, what
was lost or sent before is requested again, so the map is whole after a while, whenever the client
starts. Nothing is received but in wait(), which is to be called regularly.

Long calls release the interpreter's lock; threads may share an object.)";

constexpr char kWaitHelp[] =
    R"(Receive until something has changed, or for `timeout` seconds; return Changes.

With timeout=0 it takes what has arrived, from a log the next message.
Raises RuntimeError when the connection is lost, KeyboardInterrupt on Ctrl-C.)";

void add_state(py::class_<Self>& type) {
  type.def_property_readonly("has_ended",
                             getter([](MapClient& client) { return client.has_ended(); }),
                             "Of a log: it is read. On the bus: the map is complete, and nothing "
                             "is missing that is still sent.");
  type.def_property_readonly("is_complete",
                             getter([](MapClient& client) { return client.is_complete(); }),
                             "The final piece and all others are segmented.");
  type.def_property_readonly("problem", text_getter(&MapClient::problem),
                             "What is missing: segments, points or corrections; empty: nothing.");
  type.def_property_readonly("damage", text_getter(&MapClient::damage),
                             "Of a log: where and how it is damaged; empty: it is not.");
  type.def_property_readonly("dropped", text_getter(&MapClient::dropped),
                             "How many messages were refused, and why the last was; empty: none.");
  type.def_property_readonly("newest_update", getter([](MapClient& client) {
                               const SegmentUpdate* const newest = client.newest_update();
                               return newest != nullptr ? std::optional(*newest) : std::nullopt;
                             }),
                             "Names, sessions and counts of the map, an Update without arrays; "
                             "None: nothing was received.");
  type.def_property_readonly(
      "camera", getter([](MapClient& client) { return client.camera(); }),
      "The newest CameraPose of the map; None: none was received, or the map is not "
      "known yet.");
}

void add_map(py::class_<Self>& type) {
  type.def_property_readonly("pieces", getter([](MapClient& client) { return client.pieces(); }),
                             "Numbers of the pieces that were received, ascending.");
  type.def(
      "points",
      [](Self& self, std::int32_t piece) {
        return array_of(self.with([&](MapClient& client) { return client.points_W(piece); }));
      },
      py::arg("piece"),
      "(N,) of dtype POINT, read-only: the points of a piece where it is now; metres, W.\n"
      "The array never changes: after a change of the piece, ask again.");
  type.def(
      "labels",
      [](Self& self, std::int32_t piece) {
        return array_of(self.with([&](MapClient& client) { return client.labels(piece); }));
      },
      py::arg("piece"),
      "(N,) uint32: the segment of each of these points; 0: none, or not segmented yet.");
  type.def(
      "segments",
      [](Self& self) {
        return array_of(self.with([](MapClient& client) { return client.segments(); }));
      },
      "(S,) of dtype SEGMENT: every segment, by ascending id; metres, W.");
  type.def(
      "objects",
      [](Self& self) { return self.with([](MapClient& client) { return client.objects(); }); },
      "List of Object: the known objects that kintsugi-objects detect has found and that are not\n"
      "gone. Each is repeated about once a second: just after connect() some may be missing.");
  type.def(
      "birth",
      [](Self& self, std::uint32_t id) -> py::object {
        const auto birth = self.with([&](MapClient& client) { return client.birth(id); });
        if (!birth) return py::none();
        return py::make_tuple(birth->slice_id, birth->parent_id);
      },
      py::arg("id"),
      "(piece, parent) of a segment: with which piece it came, and from which segment it was "
      "split\n"
      "off (0: none). None: unknown.");
  type.def(
      "query", &query, py::arg("timeout") = 5.0,
      (std::string("Ask the segmenter; wait for `timeout` seconds at most.") + kQueryHelp +
       "\nRaises RuntimeError when nobody answers, and for a log, KeyboardInterrupt on Ctrl-C.")
          .c_str());
}

}  // namespace

void add_map_client(py::module_& module) {
  py::class_<Self> type(module, "MapClient", kClassHelp);
  type.def("wait", &wait, py::arg("timeout") = 1.0, kWaitHelp);
  add_state(type);
  add_map(type);

  module.def(
      "connect",
      [](const std::string& url, const std::string& map_name, bool with_points,
         const std::filesystem::path& bus_key) {
        const py::gil_scoped_release released;
        return std::make_unique<Self>(MapClient::connect({.url = url,
                                                          .map_name = map_name,
                                                          .with_points = with_points,
                                                          .bus_key = bus_key.string()}));
      },
      py::arg("url") = "", py::arg("map_name") = "", py::arg("with_points") = true,
      py::arg("bus_key") = "",
      "Follow a map on the bus; return a MapClient.\n\n"
      "url          of LCM; empty: LCM_DEFAULT_URL, or multicast on this host\n"
      "map_name     empty: the map of the first segment update that is received\n"
      "with_points  False: without points and labels, with less memory and traffic\n"
      "bus_key      file of the key of a signed bus; empty: KINTSUGI_BUS_KEY, or none\n\n"
      "Raises RuntimeError when the bus cannot be opened, or the key cannot be read.");
  module.def(
      "open_log", &open_log_of, py::arg("file"), py::arg("map_name") = "",
      py::arg("with_points") = true, py::arg("bus_key") = "", py::arg("trust_log") = false,
      "Open an LCM log, in which wait() reads on; return a MapClient. Arguments as connect();\n"
      "trust_log=True reads it whether or not it is signed, and verifies nothing.\n"
      "Raises RuntimeError when it cannot be read, is no LCM log, or is not signed with the key.");
  module.def(
      "read_log", &read_log_of, py::arg("file"), py::arg("map_name") = "",
      py::arg("with_points") = true, py::arg("bus_key") = "", py::arg("trust_log") = false,
      "Read an LCM log to its end or first damage; return a MapClient. Arguments and errors as\n"
      "open_log().");
}

}  // namespace kintsugi::python

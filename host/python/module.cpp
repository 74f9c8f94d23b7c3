// The C++ half of the Python module `raygate`: scenes, rays and images as NumPy arrays.
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "host/app/built_in.h"
#include "host/app/load.h"
#include "host/app/options.h"
#include "host/base/input_error.h"
#include "host/base/measure.h"
#include "host/base/threads.h"
#include "host/bvh/bvh.h"
#include "host/bvh/closest_point.h"
#include "host/exact/ieee_floats.h"
#include "host/film/display.h"
#include "host/film/exr.h"
#include "host/intersect/cpu/cpu_intersector.h"
#include "host/light/prepared_scene.h"
#include "host/python/winding_number.h"
#include "host/render/renderer.h"
#include "host/scene/io/mesh_builder.h"
#include "host/scene/io/scene_loader.h"
#include "host/trace/hit_table.h"
#include "host/trace/ray_table.h"
#include "host/trace/tracer.h"
#include "sim/fp/float_format.h"
#include "sim/test/fp/oracle.h"

namespace nb = nanobind;

namespace raygate {
namespace {

// Arrays of float32 are converted.
using Vectors3 = nb::ndarray<const double, nb::shape<-1, 3>, nb::device::cpu, nb::c_contig>;
using Numbers = nb::ndarray<const double, nb::shape<-1>, nb::device::cpu, nb::c_contig>;
using Three = std::array<double, 3>;
using Texts = nb::typed<nb::list, nb::str>;

/// Returns an array of data that `owner` keeps alive.
template <class T>
nb::ndarray<nb::numpy, T> array_of(const std::shared_ptr<const void>& owner, const void* data,
                                   std::initializer_list<std::size_t> shape) {
  using Owner = std::shared_ptr<const void>;
  const nb::capsule capsule(new Owner(owner),
                            [](void* p) noexcept { delete static_cast<Owner*>(p); });
  return {const_cast<void*>(data), shape, capsule};
}

/// Keyword arguments and their values as text.
using Settings = std::vector<std::pair<std::string, std::string>>;

/// Options of a function of the module, set by its keyword arguments.
struct Keywords : OptionTable {
  Keywords() : OptionTable("", "", "") {
    number("--threads", "", "", threads, kThreadRange, kInPython);
  }
  void read(const Settings& settings) {
    std::vector<OptionValue> values;
    for (const auto& [name, text] : settings) {
      values.push_back({name, text});
      require(values.back(), kInPython);
    }
    OptionTable::read(std::move(values));
  }

  int threads = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
};

struct SceneKeywords : Keywords {
  explicit SceneKeywords(const Settings& settings) {
    number("--smooth", "", "", smooth, kSmoothRange, kInPython);
    choice<bool>("--degenerate", "", "", refuses, {{"leave out", false}, {"refuse", true}},
                 kInPython);
    read(settings);
  }
  std::optional<double> smooth;
  bool refuses = false;  // faces without area are errors
};

glm::dvec3 vector_at(const Vectors3& vectors, std::size_t i) {
  return {vectors(i, 0), vectors(i, 1), vectors(i, 2)};
}

glm::dvec3 vector_of(const Three& v) { return {v[0], v[1], v[2]}; }

/// Returns text from the system as a str: bytes that are not UTF-8 become surrogates.
nb::object text_of(const std::string& text) {
  return nb::steal(
      PyUnicode_DecodeFSDefaultAndSize(text.data(), static_cast<Py_ssize_t>(text.size())));
}

nb::object text_of(const Material& material) { return text_of(material.name); }
template <class Element>
Texts texts_of(const std::vector<Element>& elements) {
  Texts list;
  for (const Element& element : elements) list.append(text_of(element));
  return list;
}

/// Rows of a structured array, as bytes.
using Bytes = nb::ndarray<nb::numpy, std::uint8_t, nb::ndim<1>>;
Bytes bytes_of(const std::shared_ptr<const void>& owner, const void* data, std::size_t size) {
  return Bytes(array_of<std::uint8_t>(owner, data, {size}));
}

/// Returns the `count` rows compute(0), compute(1) and so on, computed without Python's lock. Calls
/// checkpoint() every `interval` rows.
template <class Row, class Compute>
Bytes computed_rows(std::size_t count, std::size_t interval, const Compute& compute) {
  const auto rows = std::make_shared<std::vector<Row>>(count);
  {
    const nb::gil_scoped_release release;
    for (std::size_t i = 0; i < count; ++i) {
      if (i % interval == 0) checkpoint();
      (*rows)[i] = compute(i);
    }
  }
  return bytes_of(rows, rows->data(), count * sizeof(Row));
}

/// Returns the result of `encode`, which runs without Python's lock.
template <class Encode>
nb::bytes python_bytes(const Encode& encode) {
  const std::string text = [&] {
    const nb::gil_scoped_release release;
    return encode();
  }();
  return nb::bytes(text.data(), text.size());
}

struct PythonFilm {
  std::shared_ptr<const Film> film;
  ExrMetadata metadata;
};

class PythonScene {
 public:
  PythonScene(const nb::bytes& file, const Settings& settings) {
    const SceneKeywords keywords(settings);
    const std::filesystem::path path = std::string(file.c_str(), file.size());
    const nb::gil_scoped_release release;
    file_ = read_scene_file(path);
    scene_ = load(file_, {.smooth = keywords.smooth}, file_.environment);
    resolve_instances(scene_, InstanceMode::kFlatten, path);
    build(keywords);
  }

  /// Makes a scene of triangles from their corners. `name` is the array's name in messages.
  PythonScene(const std::string& name, const Vectors3& corners, const Settings& settings) {
    const SceneKeywords keywords(settings);
    const nb::gil_scoped_release release;
    MeshBuilder mesh(name, MeshBuilder::Source::kArray);
    for (std::size_t i = 0; i + 2 < corners.shape(0); i += 3) {
      std::array<FaceCorner, 3> face;
      for (std::size_t k = 0; k < 3; ++k) {
        mesh.add_position(vector_at(corners, i + k));
        face[k].position = static_cast<std::uint32_t>(i + k);
      }
      mesh.add_face(face, i / 3 + 1);
    }
    mesh.build_plain({.smooth = keywords.smooth}, scene_);
    build(keywords);
  }

  [[nodiscard]] const Scene& scene() const { return scene_; }
  [[nodiscard]] std::vector<std::size_t> degenerate_faces() const {
    std::vector<std::size_t> numbers;
    for (std::size_t i = 0; i < scene_.triangles.size(); ++i) {
      if (is_left_out(scene_.triangles[i])) numbers.push_back(i);
    }
    return numbers;
  }
  [[nodiscard]] std::uint64_t rounded_rays() const { return rounded_rays_; }

  /// Returns the rows of HitTable as bytes, and the names and types of their fields. Origins,
  /// directions and limits must be equally many.
  std::pair<Bytes, Settings> trace_rays(const Vectors3& origins, const Vectors3& directions,
                                        const std::optional<Numbers>& limits,
                                        const std::vector<std::string>& columns,
                                        const Settings& settings) const {
    const std::size_t count = origins.shape(0);
    Hits asked = Hits::kNearest;
    Keywords keywords;
    keywords.choice<Hits>("--hits", "", "", asked,
                          {{"nearest", Hits::kNearest}, {"any", Hits::kAny}, {"all", Hits::kAll}},
                          kInPython);
    keywords.read(settings);
    const HitTable answers(scene_, *bvh_, columns_of(columns, asked, ""), TableFormat::kBinary);
    // Rays that a thread traces between two checkpoints: about 50 ms of work.
    double block_size = 64.0;
    bool is_new_round = true;
    Stopwatch round;
    const auto read = [&, next = std::size_t{0}](std::size_t most, RayTable& block) mutable {
      if (std::exchange(is_new_round, false)) {
        const double factor = std::clamp(0.05 / std::max(round.lap(), 1e-6), 0.1, 4.0);
        block_size = std::clamp(factor * block_size, 16.0, 0x1p14);
      }
      block.clear(next);
      for (; block.rays.size() < std::min(most, std::size_t(block_size)) && next < count; ++next) {
        const char* const wrong = block.add(
            vector_at(origins, next), vector_at(directions, next),
            limits ? (*limits)(next) : std::numeric_limits<double>::infinity(), scene_.origin);
        if (wrong != nullptr) throw InputError("ray " + std::to_string(next) + ": " + wrong);
      }
      return !block.rays.empty();
    };
    const auto rows = std::make_shared<std::string>();
    rows->reserve(count * answers.fields().size() * 8);
    {
      const nb::gil_scoped_release release;
      const auto write = [&](std::string_view bytes) {
        rows->append(bytes);
        is_new_round = true;
      };
      rounded_rays_ += trace(read, asked, *bvh_, answers, intersectors(),
                             static_cast<unsigned>(keywords.threads), write)
                           .rounded;
    }
    return {bytes_of(rows, rows->data(), rows->size()), answers.fields()};
  }

  /// Returns a row for each point, as bytes: triangle, int64; distance, x, y, z.
  [[nodiscard]] Bytes closest_points(const Vectors3& points) const {
    struct Row {
      std::int64_t triangle;
      double distance, x, y, z;
    };
    return computed_rows<Row>(points.shape(0), 1, [&](std::size_t i) -> Row {
      const ClosestPoint found = closest_point(*bvh_, vector_at(points, i) - scene_.origin);
      const glm::dvec3 at = found.point + scene_.origin;
      return {bvh_->triangle_of(found.primitive), found.distance, at.x, at.y, at.z};
    });
  }

  /// Returns a WindingNumbers::Number for each point, as bytes. `crossings`: how often a ray from
  /// the point in this direction leaves triangles, less how often it enters them.
  [[nodiscard]] Bytes winding_numbers(const Vectors3& points, const Numbers& crossings,
                                      const Three& direction) const {
    const glm::dvec3 away = -glm::normalize(vector_of(direction));
    return computed_rows<WindingNumbers::Number>(points.shape(0), 1, [&](std::size_t i) {
      std::call_once(has_winding_, [&] { winding_.emplace(scene_, *bvh_); });
      return winding_->at(vector_at(points, i), crossings(i), away);
    });
  }

  /// Returns the film's channels by name, and the film.
  std::pair<nb::typed<nb::dict, nb::str, nb::ndarray<nb::numpy>>, PythonFilm> render_film(
      const std::optional<Three>& eye, const std::optional<Three>& target,
      const std::optional<Three>& up, const Settings& settings) const {
    RenderSettings chosen;
    chosen.channels = {.position = true, .albedo = true, .object = true};
    CameraRequest camera = file_.camera;
    Keywords keywords;
    keywords.number("--width", "", "", chosen.width, kSideRange, kInPython);
    keywords.number("--height", "", "", chosen.height, kSideRange, kInPython);
    keywords.number("--fov", "", "", camera.fov, kFovRange, kInPython);
    add_light_options(keywords, chosen);
    keywords.read(settings);
    check_light_options(keywords, scene_.environment.has_value(), chosen);
    chosen.threads = keywords.threads;
    const int width = chosen.width, height = chosen.height;
    if (std::int64_t{width} * height > kMaxPixels) {
      throw InputError("width, height: found " + std::to_string(width) + " x " +
                       std::to_string(height) + ", expected at most " + std::to_string(kMaxPixels) +
                       " pixels");
    }
    if (eye) camera.eye = vector_of(*eye);
    if (target) camera.target = vector_of(*target);
    if (up) camera.up = vector_of(*up);
    const Framing framing = frame_picture(camera, scene_, static_cast<double>(width) / height);
    const auto film = std::make_shared<Film>();
    {
      const nb::gil_scoped_release release;
      RenderStats stats;
      *film = render({*prepared_, framing.camera, chosen, framing.lights}, intersectors(), stats,
                     {.progress = [](double) {
                       checkpoint();
                       return true;
                     }});
    }
    const auto h = static_cast<std::size_t>(height), w = static_cast<std::size_t>(width);
    nb::dict channels;
    channels["color"] = array_of<float>(film, film->color.data(), {h, w, 4});
    channels["depth"] = array_of<float>(film, film->depth.data(), {h, w});
    channels["normal"] = array_of<float>(film, film->normal.data(), {h, w, 3});
    channels["point"] = array_of<float>(film, film->position.data(), {h, w, 3});
    channels["albedo"] = array_of<float>(film, film->albedo.data(), {h, w, 3});
    channels["triangle"] = array_of<std::uint32_t>(film, film->primitive.data(), {h, w});
    channels["object"] = array_of<std::uint32_t>(film, film->object.data(), {h, w});
    ExrMetadata metadata{
        {{"software", kSoftware}, {"scene", ""}, {"seed", std::to_string(chosen.seed)}}};
    return {std::move(channels), PythonFilm{film, std::move(metadata)}};
  }

 private:
  void build(const SceneKeywords& keywords) {
    if (const auto faces = degenerate_faces(); keywords.refuses && !faces.empty()) {
      throw InputError("degenerate: found face " + std::to_string(faces[0]) +
                       " without area, and " + std::to_string(faces.size() - 1) +
                       " more, expected none");
    }
    bvh_ = std::make_unique<Bvh>(scene_, keywords.threads);
    prepared_ = std::make_unique<PreparedScene>(scene_, *bvh_);
  }

  [[nodiscard]] IntersectorFactory intersectors() const {
    return [this] { return std::make_unique<CpuIntersector>(*bvh_); };
  }

  SceneFile file_;
  Scene scene_;
  std::unique_ptr<Bvh> bvh_;
  std::unique_ptr<PreparedScene> prepared_;
  mutable std::atomic<std::uint64_t> rounded_rays_ = 0;
  mutable std::once_flag has_winding_;
  mutable std::optional<WindingNumbers> winding_;
};

// Arithmetic of raygate.float by the reference model of the simulated float cores.

using FloatWords = nb::ndarray<const std::uint32_t, nb::shape<-1>, nb::device::cpu, nb::c_contig>;

constexpr std::size_t kOperations = 1 << 12;  // between two checkpoints

/// Returns a FloatResult for each pair of words, as bytes. `a` and `b` have the same length, and
/// their words fit the format; float.py checks that. `is_after`: Tininess::kAfterRounding.
Bytes float_run(int op, const FloatWords& a, const FloatWords& b, int exp_bits, int frac_bits,
                int rounding, bool is_after) {
  const FloatFormat format{exp_bits, frac_bits};
  const auto operation = static_cast<FloatOp>(op);
  return computed_rows<FloatResult>(a.shape(0), kOperations, [&](std::size_t i) {
    const std::uint32_t x = a.data()[i], y = b.data()[i];
    return is_comparison(operation)
               ? oracle_compare(format, operation, x, y)
               : round_exact(format, exact_result(format, operation, x, y), rounding_of(rounding),
                             static_cast<Tininess>(is_after));
  });
}

/// Returns x in the form that exact_result() returns.
ExactValue exact_value(double x) {
  constexpr int kBits = 62;  // of a significand, as in the oracle
  ExactValue value;
  value.negative = std::signbit(x);
  if (std::isnan(x)) {
    value.kind = ExactValue::Kind::kNan;
  } else if (std::isinf(x)) {
    value.kind = ExactValue::Kind::kInfinity;
  } else if (x != 0.0) {
    int exponent = 0;
    value.significand =
        static_cast<std::uint64_t>(std::ldexp(std::frexp(std::abs(x), &exponent), kBits));
    value.exponent = exponent - kBits;
  }
  return value;
}

/// Returns a FloatResult for each value, as bytes.
Bytes float_encode(const Numbers& values, int exp_bits, int frac_bits, int rounding,
                   bool is_after) {
  return computed_rows<FloatResult>(values.shape(0), kOperations, [&](std::size_t i) {
    return round_exact({exp_bits, frac_bits}, exact_value(values.data()[i]), rounding_of(rounding),
                       static_cast<Tininess>(is_after));
  });
}

/// Calls a Python function with IEEE 754 arithmetic. Checkpoints run Python's signal handlers, at
/// most every 20 ms; an exception of a handler, such as KeyboardInterrupt, ends the call.
nb::object call_in_context(const nb::callable& function, const nb::args& arguments,
                           const nb::kwargs& keywords) {
  const IeeeFloats floats;
  auto last = std::chrono::steady_clock::now();
  const CheckpointScope signals([&] {
    const auto now = std::chrono::steady_clock::now();
    if (now - last < std::chrono::milliseconds(20)) return;
    last = now;
    const nb::gil_scoped_acquire gil;
    if (PyErr_CheckSignals() != 0) throw nb::python_error();
  });
  return function(*arguments, **keywords);
}

}  // namespace
}  // namespace raygate

NB_MODULE(_raygate, m) {
  using namespace nb::literals;
  using namespace raygate;
  {
    const IeeeFloats floats;
    require_ieee_floats();
  }
  m.def("call_in_context", &call_in_context,
        nb::sig("def call_in_context(function: object, *arguments: object, **keywords: object) "
                "-> object"));
  static const nb::object input_error =
      nb::exception<InputError>(m, "InputError", PyExc_ValueError);
  input_error.attr("__doc__") =
      "Invalid input: a ValueError with one line, what was found and what was expected.";
  nb::register_exception_translator([](const std::exception_ptr& error, void*) {
    try {
      std::rethrow_exception(error);
    } catch (const InputError& unusable) {
      PyErr_SetObject(input_error.ptr(), text_of(unusable.what()).ptr());
    }
  });
  m.def("float_run", &float_run);
  m.def("float_encode", &float_encode);
  m.attr("software") = kSoftware;
  nb::class_<PythonFilm>(m, "Film")
      .def("png",
           [](const PythonFilm& f, double exposure) {
             return python_bytes(
                 [&] { return encode_png(to_display(*f.film, {.exposure = exposure})); });
           })
      .def("exr", [](const PythonFilm& f) {
        return python_bytes([&] { return encode_exr(*f.film, f.metadata); });
      });
  nb::class_<PythonScene>(m, "Scene")
      .def(nb::init<const nb::bytes&, const Settings&>())
      .def(nb::init<const std::string&, const Vectors3&, const Settings&>())
      .def_prop_ro(
          "triangle_count", [](const PythonScene& s) { return s.scene().triangles.size(); },
          "Number of triangles, including those without area.")
      .def_prop_ro(
          "objects", [](const PythonScene& s) { return texts_of(s.scene().objects); },
          "Names of the objects (`o` and `g` of an OBJ file), by the numbers in hits[\"object\"].")
      .def_prop_ro(
          "materials", [](const PythonScene& s) { return texts_of(s.scene().materials); },
          "Names of the materials, by the numbers in hits[\"material\"].")
      .def_prop_ro("degenerate_faces", &PythonScene::degenerate_faces,
                   "Numbers of the triangles without area.")
      .def_prop_ro(
          "warnings", [](const PythonScene& s) { return texts_of(s.scene().warnings); },
          "A line for each thing in the file that was ignored or changed.")
      .def_prop_ro(
          "rounding",
          [](const PythonScene& s) {
            return std::pair(s.scene().rounding.corners, s.scene().rounding.most);
          },
          "Number of vertices that are not stored as in the file, and the largest error of a "
          "coordinate. Files of glTF, meshes with instances and numbers below 2^-97 are rounded.")
      .def_prop_ro("rounded_rays", &PythonScene::rounded_rays,
                   "Number of rays of all calls so far that were rounded: see trace().")
      .def("_trace", &PythonScene::trace_rays, "origins"_a, "directions"_a, "limits"_a.none(),
           "columns"_a, "settings"_a)
      .def("_winding", &PythonScene::winding_numbers, "points"_a, "crossings"_a, "direction"_a)
      .def("_closest", &PythonScene::closest_points, "points"_a)
      .def("_render", &PythonScene::render_film, "eye"_a.none(), "target"_a.none(), "up"_a.none(),
           "settings"_a);
}

// Arithmetic of raygate.float by the reference model of the simulated float cores.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <cstddef>
#include <initializer_list>
#include <memory>

namespace raygate {

/// Returns an array of data that `owner` keeps alive.
template <class T>
nanobind::ndarray<nanobind::numpy, T> array_of(const std::shared_ptr<const void>& owner,
                                               const void* data,
                                               std::initializer_list<std::size_t> shape) {
  using Owner = std::shared_ptr<const void>;
  const nanobind::capsule capsule(new Owner(owner),
                                  [](void* p) noexcept { delete static_cast<Owner*>(p); });
  return {const_cast<void*>(data), shape, capsule};
}

/// Adds float_run and float_encode, which float.py calls.
void add_float_reference(nanobind::module_& m);

}  // namespace raygate

#pragma once
// An array that a binding fills and then hands to NumPy, which owns it from there on.
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <initializer_list>
#include <vector>

template <class T>
class Array {
 public:
  explicit Array(std::initializer_list<int> shape) {
    std::size_t size = 1;
    for (int n : shape) {
      shape_.push_back(static_cast<std::size_t>(n));
      size *= static_cast<std::size_t>(n);
    }
    data_ = new T[size]();
    owner_ = nanobind::capsule(data_, [](void* p) noexcept { delete[] static_cast<T*>(p); });
  }

  T* data() { return data_; }
  nanobind::ndarray<nanobind::numpy, T> numpy() const {
    return nanobind::ndarray<nanobind::numpy, T>(data_, shape_.size(), shape_.data(), owner_);
  }

 private:
  std::vector<std::size_t> shape_;
  T* data_ = nullptr;
  nanobind::capsule owner_;
};

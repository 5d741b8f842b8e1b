#pragma once
// Arrays in device memory, and errors of the CUDA runtime as exceptions.
#include <cuda_runtime.h>

#include <stdexcept>
#include <string>

namespace fabrica {

// Throws std::runtime_error with CUDA's own words.
inline void check(cudaError_t error) {
  if (error != cudaSuccess)
    throw std::runtime_error(std::string("CUDA: ") + cudaGetErrorString(error));
}

template <class T>
class DeviceBuffer {
 public:
  DeviceBuffer() = default;
  DeviceBuffer(const DeviceBuffer&) = delete;
  DeviceBuffer& operator=(const DeviceBuffer&) = delete;
  ~DeviceBuffer() { cudaFree(data_); }

  void resize(std::size_t n) {
    if (n == size_) return;
    check(cudaFree(data_));
    data_ = nullptr, size_ = 0;
    if (n > 0) check(cudaMalloc(reinterpret_cast<void**>(&data_), n * sizeof(T)));
    size_ = n;
  }
  // Vector: any contiguous container of T
  template <class Vector>
  void upload(const Vector& v) {
    resize(v.size());
    if (size_ > 0) check(cudaMemcpy(data_, v.data(), size_ * sizeof(T), cudaMemcpyHostToDevice));
  }
  template <class Vector>
  void download(Vector& v) const {
    v.resize(size_);
    if (size_ > 0) check(cudaMemcpy(v.data(), data_, size_ * sizeof(T), cudaMemcpyDeviceToHost));
  }
  T* data() const { return data_; }
  std::size_t size() const { return size_; }

 private:
  T* data_ = nullptr;
  std::size_t size_ = 0;
};

}  // namespace fabrica

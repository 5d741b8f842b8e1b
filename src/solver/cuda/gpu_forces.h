#pragma once
// A model of bricks, tetrahedra or Belytschko-Tsay shells on one GPU: element forces and free
// flight of the nodes, with the bits of the CPU driver (docs/manual/gpu.md). Contact, constraints,
// loads and rigid bodies are not here; Simulation stays on the CPU.
#include <memory>
#include <string>

#include "solver/cuda/gpu_arrays.h"
#include "solver/tiles.h"

namespace fabrica {

// Whether this process can use a GPU.
bool cuda_available();
// Name of that GPU, or empty.
std::string cuda_device_name();

class GpuForces {
 public:
  // Prepares the kernels of the tiles' classes. Throws std::invalid_argument naming the part whose
  // element, law or curve has no GPU form, std::runtime_error with CUDA's words when the device
  // refuses.
  GpuForces(const Model& model, const Tiles& tiles);
  ~GpuForces();
  GpuForces(const GpuForces&) = delete;
  GpuForces& operator=(const GpuForces&) = delete;

  // Copies history and motion to the device. Throws std::invalid_argument if a node is not free.
  void upload(const Tiles& tiles, const State& state);
  // Advances `count` steps, or fewer where the run ends; returns when the device is done.
  void step(int count, const GpuStepping& stepping = {});
  // Copies history, partial forces, motion, time and energies back; the forces belong to the last
  // step's start.
  void download(Tiles& tiles, State& state) const;
  GpuEnding ending() const;

 private:
  struct Device;
  std::unique_ptr<Device> device_;
};

}  // namespace fabrica

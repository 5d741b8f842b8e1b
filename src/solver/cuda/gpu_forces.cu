// The GPU driver: what lies on the device, and the kernels of one step in their order.
#include <algorithm>
#include <stdexcept>
#include <vector>

#include "solver/cuda/device_buffer.cuh"
#include "solver/cuda/gpu_forces.h"
#include "solver/cuda/step_phases.h"
#include "solver/cuda/tile_launcher.h"

namespace fabrica {
namespace {

constexpr int step_threads = 512, node_threads = 128;

// one block: smallest step and health of all tiles, then the clock
__global__ void choose_step_kernel(const __grid_constant__ GpuArrays g,
                                   const __grid_constant__ GpuStepping stepping) {
  __shared__ double step[step_threads];
  __shared__ GpuEnding ending[step_threads];
  StepFinding mine;
  for (int t = int(threadIdx.x); t < g.tiles; t += step_threads)
    look_at(g.tile[t], g.result[t], mine);
  const int me = int(threadIdx.x);
  step[me] = mine.step, ending[me] = mine.ending;
  // in pairs: neither the smallest step nor the worst ending depends on the order
  for (int half = step_threads / 2; half > 0; half /= 2) {
    __syncthreads();
    if (me >= half) continue;
    join(mine, {step[me + half], ending[me + half]});
    step[me] = mine.step, ending[me] = mine.ending;
  }
  if (me == 0) choose_step(mine, stepping, *g.clock);
}

__global__ void node_kernel(const __grid_constant__ GpuArrays g) {
  const int n = int(blockIdx.x) * node_threads + int(threadIdx.x);
  if (n < g.node_count) advance_node(g, n);
}

// tiles of one class stand together
struct ClassRange {
  std::unique_ptr<TileLauncher> launcher;
  int first = 0, count = 0;
};

std::unique_ptr<TileLauncher> make_launcher(const Model& model, const TileClass& c,
                                            int most_nodes) {
  const Part& part = model.parts[c.part];
  const Material& material = model.materials[part.material];
  const CardParameters parameters(model, *material.card);
  std::unique_ptr<CardParameters> eos;
  if (part.eos >= 0) eos = std::make_unique<CardParameters>(model, *model.cards[part.eos]);
  const TileClassInput input{material.law, parameters, eos.get(),
                             c.parameters, c.fields,   most_nodes};
  switch (c.kind) {
    case ElementKind::hex8:
      return make_brick_launcher(input, false);
    case ElementKind::hex8_exact:
      return make_brick_launcher(input, true);
    case ElementKind::tet4:
      return make_tet_launcher(input);
    case ElementKind::shell_bt:
      return make_shell_launcher(input);
    default:
      throw std::invalid_argument("this element formulation does not run on the GPU");
  }
}

// A stream of the device and the recorded step; both end with their owner.
struct Stream {
  cudaStream_t stream{};
  Stream() { check(cudaStreamCreateWithFlags(&stream, cudaStreamNonBlocking)); }
  ~Stream() { cudaStreamDestroy(stream); }
  Stream(const Stream&) = delete;
  Stream& operator=(const Stream&) = delete;
};
class RecordedStep {
 public:
  template <class Queue>
  RecordedStep(cudaStream_t stream, Queue queue) {
    check(cudaStreamBeginCapture(stream, cudaStreamCaptureModeThreadLocal));
    queue();
    check(cudaStreamEndCapture(stream, &graph_));
    check(cudaGraphInstantiate(&exec_, graph_, 0));
  }
  ~RecordedStep() {
    if (exec_) cudaGraphExecDestroy(exec_);
    if (graph_) cudaGraphDestroy(graph_);
  }
  RecordedStep(const RecordedStep&) = delete;
  RecordedStep& operator=(const RecordedStep&) = delete;
  void launch(cudaStream_t stream) const { check(cudaGraphLaunch(exec_, stream)); }

 private:
  cudaGraph_t graph_{};
  cudaGraphExec_t exec_{};
};

}  // namespace

bool cuda_available() {
  int count = 0;
  return cudaGetDeviceCount(&count) == cudaSuccess && count > 0;
}

std::string cuda_device_name() {
  cudaDeviceProp properties{};
  return cuda_available() && cudaGetDeviceProperties(&properties, 0) == cudaSuccess
             ? properties.name
             : "";
}

struct GpuForces::Device {
  DeviceBuffer<GpuTile> tile;
  DeviceBuffer<int> node, corner_first, partial_first, partial;
  DeviceBuffer<std::uint16_t> connectivity, corner;
  DeviceBuffer<Real> state;
  DeviceBuffer<ForceRecord> force, moment;
  DeviceBuffer<NodeMotion> nodes;
  DeviceBuffer<NodeSpin> spins;
  DeviceBuffer<TileResult> result;
  DeviceBuffer<GpuClock> clock;
  std::vector<ClassRange> classes;
  Energies at_upload;
  Stream stream;

  GpuArrays arrays() const {
    GpuArrays g;
    g.tile = tile.data(), g.node = node.data(), g.connectivity = connectivity.data();
    g.corner_first = corner_first.data(), g.corner = corner.data();
    g.partial_first = partial_first.data(), g.partial = partial.data();
    g.state = state.data(), g.force = force.data(), g.moment = moment.data();
    g.nodes = nodes.data(), g.spins = spins.data();
    g.result = result.data(), g.clock = clock.data();
    g.tiles = int(tile.size()), g.node_count = int(nodes.size());
    return g;
  }
  void queue_step(const GpuStepping& stepping) const {
    const GpuArrays g = arrays();
    for (const ClassRange& c : classes) c.launcher->launch(g, c.first, c.count, stream.stream);
    choose_step_kernel<<<1, step_threads, 0, stream.stream>>>(g, stepping);
    check(cudaGetLastError());
    node_kernel<<<(g.node_count + node_threads - 1) / node_threads, node_threads, 0,
                  stream.stream>>>(g);
    check(cudaGetLastError());
  }
  GpuClock read_clock() const {
    std::vector<GpuClock> c;
    clock.download(c);
    if (c.empty()) throw std::runtime_error("GpuForces: nothing has been uploaded");
    return c[0];
  }
};

GpuForces::GpuForces(const Model& model, const Tiles& tiles) : device_(std::make_unique<Device>()) {
  std::vector<ClassRange> classes(tiles.classes.size());
  std::vector<int> most_nodes(classes.size(), 0);
  for (int i = 0; i < int(tiles.tiles.size()); ++i) {
    const Tile& t = tiles.tiles[i];
    ClassRange& c = classes[t.tile_class];
    if (c.count++ == 0) c.first = i;
    most_nodes[t.tile_class] = std::max(most_nodes[t.tile_class], t.node_count);
  }
  for (std::size_t i = 0; i < classes.size(); ++i) {
    if (classes[i].count == 0) continue;
    try {
      classes[i].launcher = make_launcher(model, tiles.classes[i], most_nodes[i]);
    } catch (const std::invalid_argument& e) {
      throw std::invalid_argument("part " + std::to_string(model.parts[tiles.classes[i].part].id) +
                                  ": " + e.what());
    }
    device_->classes.push_back(std::move(classes[i]));
  }
  const GpuLayout layout(tiles);
  device_->tile.upload(layout.tile);
  device_->corner_first.upload(layout.corner_first), device_->corner.upload(layout.corner);
  device_->node.upload(tiles.node), device_->connectivity.upload(tiles.connectivity);
  device_->partial_first.upload(tiles.partial_first), device_->partial.upload(tiles.partial);
}

GpuForces::~GpuForces() = default;

void GpuForces::upload(const Tiles& tiles, const State& state) {
  for (NodeOwner owner : state.owner)
    if (owner != NodeOwner::free)
      throw std::invalid_argument("rigid bodies and tied nodes do not run on the GPU");
  device_->state.upload(tiles.state_);
  device_->force.upload(tiles.force), device_->moment.upload(tiles.moment);
  device_->nodes.upload(state.nodes);
  if (tiles.any_rotations) device_->spins.upload(state.spins);
  device_->result.upload(std::vector<TileResult>(tiles.tiles.size(), TileResult{}));
  const GpuClock clock{state.dt_previous, 0, state.time_sum, state.cycle, GpuEnding::running};
  device_->clock.upload(std::vector<GpuClock>{clock});
  device_->at_upload = state.energy;
  check(cudaDeviceSynchronize());
}

void GpuForces::step(int count, const GpuStepping& stepping) {
  const cudaStream_t stream = device_->stream.stream;
  const RecordedStep recorded(stream, [&] { device_->queue_step(stepping); });
  for (int i = 0; i < count; ++i) recorded.launch(stream);
  check(cudaStreamSynchronize(stream));
}

void GpuForces::download(Tiles& tiles, State& state) const {
  const GpuClock clock = device_->read_clock();
  device_->state.download(tiles.state_);
  device_->force.download(tiles.force), device_->moment.download(tiles.moment);
  device_->nodes.download(state.nodes);
  if (tiles.any_rotations) device_->spins.download(state.spins);
  std::vector<TileResult> result;
  device_->result.download(result);
  state.energy = device_->at_upload;
  for (std::size_t i = 0; i < result.size(); ++i) {
    Tile& t = tiles.tiles[i];
    const TileResult& r = result[i];
    t.internal = r.internal, t.hourglass = r.hourglass, t.damping = r.damping;
    t.time_step = r.time_step, t.smallest_volume = r.smallest_volume;
    state.energy.internal += r.internal_sum, state.energy.hourglass += r.hourglass_sum;
    state.energy.damping += r.damping_sum;
  }
  state.dt = state.dt_previous = clock.dt;
  state.time_sum = clock.time, state.time = clock.time.value(), state.cycle = clock.cycle;
  tiles.sum_partials(state, 0, int(state.nodes.size()));
}

GpuEnding GpuForces::ending() const { return device_->read_clock().ending; }

}  // namespace fabrica

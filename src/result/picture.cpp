#include "result/picture.h"

#include <dlfcn.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <stdexcept>

#include "result/picture/module.h"

namespace fabrica {
namespace module {
namespace {

// Starts Xvfb, which tells the display number it chose through a pipe; returns {process, number},
// or -1.
std::pair<int, std::string> start_server() {
  int ends[2];
  if (pipe(ends) != 0) return {-1, ""};
  const pid_t parent = getpid();
  const pid_t child = fork();
  if (child == 0) {
    // the server must not outlive the program, however that ends
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != parent) _exit(127);
    const int quiet = open("/dev/null", O_RDWR);
    dup2(quiet, 0);
    dup2(quiet, 1);
    dup2(quiet, 2);
    dup2(ends[1], 3);
    execlp("Xvfb", "Xvfb", "-displayfd", "3", "-screen", "0", "1280x1024x24", "-nolisten", "tcp",
           nullptr);
    _exit(127);
  }
  close(ends[1]);
  std::string number;
  char c = 0;
  pollfd wait{ends[0], POLLIN, 0};
  while (child > 0 && poll(&wait, 1, 20000) > 0 && read(ends[0], &c, 1) == 1 && c != '\n')
    number += c;
  close(ends[0]);
  if (child > 0 && c == '\n') return {child, number};
  if (child > 0) {
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
  }
  return {-1, ""};
}

// A server that no program has come to yet takes note of the signal and may then sleep on for
// minutes: another one wakes it.
void end_server(pid_t process) {
  for (int tries = 0; tries < 500; ++tries) {
    kill(process, tries < 250 ? SIGTERM : SIGKILL);
    if (waitpid(process, nullptr, WNOHANG) != 0) return;
    usleep(10000);
  }
}

std::string program_folder() {
  std::error_code error;
  return std::filesystem::read_symlink("/proc/self/exe", error).parent_path().string();
}

}  // namespace

Display::Display() {
  if (const char* d = std::getenv("DISPLAY")) {
    had_earlier_ = true;
    earlier_ = d;
  }
  setenv("LIBGL_ALWAYS_SOFTWARE", "1", 1);
  const auto [process, number] = start_server();
  process_ = process;
  if (process_ > 0)
    setenv("DISPLAY", (":" + number).c_str(), 1);
  else if (!had_earlier_)
    throw std::runtime_error(
        "pictures are drawn on a virtual display, and Xvfb could not be started: install the "
        "packages xvfb and "
        "libgl1-mesa-dri");
}

Display::~Display() {
  if (process_ <= 0) return;
  end_server(process_);
  had_earlier_ ? setenv("DISPLAY", earlier_.c_str(), 1) : unsetenv("DISPLAY");
}

void* load(const char* function) {
  // beside the program, where it is installed, where it was built
  const std::string folder = program_folder();
  std::string reasons;
  for (const std::string& path : {folder + "/" + file_name, folder + "/../lib/fabrica/" + file_name,
                                  std::string(FABRICA_PICTURE_FOLDER "/") + file_name}) {
    if (!std::filesystem::exists(path)) continue;
    void* library = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
    void* symbol = library ? dlsym(library, function) : nullptr;
    if (symbol) return symbol;
    reasons += std::string(" (") + dlerror() + ")";
  }
  throw std::runtime_error(
      std::string("the drawing module ") + file_name +
      " was not found beside the program or cannot be loaded; it needs the package libvtk9.1" +
      reasons);
}

}  // namespace module

void render_picture(const PictureOptions& options) {
  const auto draw = reinterpret_cast<module::DrawPicture>(module::load(module::draw_picture));
  const module::Display display;
  if (const std::string error = draw(options); !error.empty()) throw std::runtime_error(error);
}

}  // namespace fabrica

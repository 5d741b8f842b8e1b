#include "deck/text.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>
#include <zstd.h>

#include <cerrno>
#include <cstring>
#include <vector>

namespace fabrica {
namespace {

class MappedText : public FileText {
 public:
  MappedText(void* data, std::size_t size) : data_(data), size_(size) {
    text = {static_cast<const char*>(data), size};
  }
  ~MappedText() override { munmap(data_, size_); }

 private:
  void* data_;
  std::size_t size_;
};

class OwnedText : public FileText {
 public:
  explicit OwnedText(std::string s) : owned_(std::move(s)) { text = owned_; }

 private:
  std::string owned_;
};

// inflates all members of a gzip file
bool inflate_gzip(std::string_view packed, std::string& out) {
  z_stream z{};
  if (inflateInit2(&z, 15 + 32) != Z_OK) return false;
  z.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));
  std::size_t left = packed.size();
  std::vector<char> chunk(1 << 18);
  int status = Z_OK;
  for (;;) {
    if (z.avail_in == 0) {
      z.avail_in = uInt(std::min<std::size_t>(left, 1u << 30));
      left -= z.avail_in;
    }
    z.next_out = reinterpret_cast<Bytef*>(chunk.data());
    z.avail_out = uInt(chunk.size());
    status = inflate(&z, Z_NO_FLUSH);
    if (status != Z_OK && status != Z_STREAM_END) break;
    out.append(chunk.data(), chunk.size() - z.avail_out);
    if (status == Z_STREAM_END) {
      if (z.avail_in == 0 && left == 0) break;
      if (inflateReset(&z) != Z_OK) break;
    } else if (z.avail_in == 0 && left == 0 && z.avail_out > 0) {
      status = Z_DATA_ERROR;
      break;
    }
  }
  inflateEnd(&z);
  return status == Z_STREAM_END;
}

bool inflate_zstd(std::string_view packed, std::string& out) {
  std::unique_ptr<ZSTD_DStream, std::size_t (*)(ZSTD_DStream*)> stream(ZSTD_createDStream(),
                                                                       ZSTD_freeDStream);
  std::vector<char> chunk(ZSTD_DStreamOutSize());
  ZSTD_inBuffer in{packed.data(), packed.size(), 0};
  std::size_t status = 0;
  for (;;) {
    ZSTD_outBuffer to{chunk.data(), chunk.size(), 0};
    status = ZSTD_decompressStream(stream.get(), &to, &in);
    if (ZSTD_isError(status)) return false;
    out.append(chunk.data(), to.pos);
    if (in.pos == in.size && to.pos < to.size) return status == 0;
  }
}

}  // namespace

std::unique_ptr<FileText> load_text(const std::filesystem::path& path, std::string& problem) {
  const int fd = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  struct stat info {};
  if (fd < 0 || fstat(fd, &info) != 0 || !S_ISREG(info.st_mode)) {
    problem = fd < 0 ? std::strerror(errno) : "not a regular file";
    if (fd >= 0) close(fd);
    return nullptr;
  }
  const auto size = std::size_t(info.st_size);
  if (size == 0) {
    close(fd);
    return std::make_unique<OwnedText>(std::string());
  }
  void* const data = mmap(nullptr, size, PROT_READ, MAP_PRIVATE, fd, 0);
  close(fd);
  if (data == MAP_FAILED) {
    problem = std::strerror(errno);
    return nullptr;
  }
  auto mapped = std::make_unique<MappedText>(data, size);
  const bool gzip = mapped->text.starts_with("\x1f\x8b"),
             zstd = mapped->text.starts_with("\x28\xb5\x2f\xfd");
  if (!gzip && !zstd) return mapped;
  std::string plain;
  if (gzip ? !inflate_gzip(mapped->text, plain) : !inflate_zstd(mapped->text, plain)) {
    problem = "compressed file is damaged";
    return nullptr;
  }
  return std::make_unique<OwnedText>(std::move(plain));
}

std::string without_tabs(std::string_view line) {
  std::string out;
  for (const char c : line) {
    if (c == '\t')
      out.append(8 - out.size() % 8, ' ');
    else
      out += c;
  }
  return out;
}

}  // namespace fabrica

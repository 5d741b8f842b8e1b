#pragma once
// LSDA: the container of binout files, a file system in a file.
//
//   file   = header (8 bytes), record 7 (offset of the first symbol table), records
//   record = LENGTH (8 bytes, counts itself), COMMAND (1), payload
//   2 CD path | 3 DATA type (1) length of name (1) name values | 4 VARIABLE name type (1) offset
//   (8) count (8) 5 BEGIN of a symbol table, its LENGTH spans the table | 6 END, offset of the next
//   table or 0 | 7 first table
//
// The tables form a chain; each names the variables written since the one before. A run that is
// killed loses the index of what it wrote after its last flush, not the file.
#include <cstdint>
#include <cstdio>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace fabrica {

enum class LsdaType : std::uint8_t { i1 = 1, i2, i4, i8, u1, u2, u4, u8, r4, r8, link };

// Bytes of one value of a type; 0 for a type that is not known.
int lsda_size(LsdaType type);

// Writes a new file; paths are absolute ("/glstat/d000001"). Throws std::runtime_error naming the
// file if the disk refuses.
class LsdaWriter {
 public:
  explicit LsdaWriter(const std::string& path);
  ~LsdaWriter();
  LsdaWriter(const LsdaWriter&) = delete;
  LsdaWriter& operator=(const LsdaWriter&) = delete;

  // Later values go to this directory.
  void cd(std::string_view directory);
  void write_text(std::string_view name, std::string_view text);
  void write_integers(std::string_view name,
                      const std::vector<std::int64_t>& values);  // i4, or i8 if needed
  void write_reals(std::string_view name, const std::vector<double>& values);  // r4
  void write_raw(std::string_view name, LsdaType type, const void* data, std::uint64_t count);
  // Writes the symbol table of what is new and hands everything to the operating system.
  void flush();

 private:
  struct Symbol {
    std::string directory, name;
    LsdaType type;
    std::uint64_t offset, count;
  };
  void put(const void* data, std::size_t bytes);
  void put_record(std::uint8_t command, std::string_view payload);

  std::string path_, directory_;
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
  std::uint64_t end_ = 0;           // length of the file
  std::uint64_t next_pointer_ = 0;  // where the offset of the next table must be written
  std::vector<Symbol> fresh_;
};

// Reads any LSDA file, little or big endian. Throws std::runtime_error if it is none.
class LsdaReader {
 public:
  struct Symbol {
    LsdaType type;
    std::uint64_t data;   // file position of the first value
    std::uint64_t count;  // values
  };
  explicit LsdaReader(const std::string& path);

  // All variables by full path ("/glstat/d000001/time"), sorted.
  const std::map<std::string, Symbol>& symbols() const { return symbols_; }
  // Names in a directory ("/glstat"), subdirectories and variables alike, sorted; empty if there is
  // none.
  std::vector<std::string> list(const std::string& directory) const;
  bool has(const std::string& path) const { return symbols_.count(path) != 0; }
  // Values converted; throws std::runtime_error naming the path if it does not exist.
  std::vector<double> reals(const std::string& path) const;
  std::vector<std::int64_t> integers(const std::string& path) const;
  std::string text(const std::string& path) const;
  // The bytes as stored.
  std::string raw(const std::string& path) const;

 private:
  struct Header {
    int length_bytes, offset_bytes, command_bytes, type_bytes;
  };
  struct Record {
    std::uint64_t position, length, payload;
    int command;
  };
  std::string bytes(std::uint64_t position, std::uint64_t count) const;
  std::uint64_t number(std::uint64_t position, int bytes) const;
  bool record_at(std::uint64_t position, Record& record) const;
  std::string enter(const std::string& from, const std::string& path) const;
  std::uint64_t read_table(const Record& begin);
  void scan(std::uint64_t position);
  const Symbol& find(const std::string& path) const;

  std::string path_;
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
  std::uint64_t size_ = 0;
  Header header_{};
  bool swap_ = false;
  std::map<std::string, Symbol> symbols_;
};

}  // namespace fabrica

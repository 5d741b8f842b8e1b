#include "result/lsda.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <stdexcept>

namespace fabrica {
namespace {

enum Command {
  null_record = 1,
  cd_record,
  data_record,
  variable_record,
  begin_table,
  end_table,
  first_table
};
constexpr std::uint64_t record_head = 9;  // LENGTH and COMMAND as we write them

template <class T>
void append(std::string& s, T value) {
  s.append(reinterpret_cast<const char*>(&value), sizeof value);
}

// values of one stored type, widened
template <class Stored, class Wide>
void widen(const std::string& raw, std::vector<Wide>& out) {
  for (std::size_t i = 0; i < out.size(); ++i) {
    Stored v;
    std::memcpy(&v, raw.data() + i * sizeof v, sizeof v);
    out[i] = Wide(v);
  }
}

template <class Wide>
std::vector<Wide> convert(const std::string& raw, LsdaType type) {
  std::vector<Wide> out(raw.size() / lsda_size(type));
  switch (type) {
    case LsdaType::i1:
      widen<std::int8_t>(raw, out);
      break;
    case LsdaType::i2:
      widen<std::int16_t>(raw, out);
      break;
    case LsdaType::i4:
      widen<std::int32_t>(raw, out);
      break;
    case LsdaType::i8:
      widen<std::int64_t>(raw, out);
      break;
    case LsdaType::u1:
      widen<std::uint8_t>(raw, out);
      break;
    case LsdaType::u2:
      widen<std::uint16_t>(raw, out);
      break;
    case LsdaType::u4:
      widen<std::uint32_t>(raw, out);
      break;
    case LsdaType::u8:
      widen<std::uint64_t>(raw, out);
      break;
    case LsdaType::r4:
      widen<float>(raw, out);
      break;
    case LsdaType::r8:
      widen<double>(raw, out);
      break;
    case LsdaType::link:
      out.clear();
      break;
  }
  return out;
}

}  // namespace

int lsda_size(LsdaType type) {
  constexpr int sizes[] = {0, 1, 2, 4, 8, 1, 2, 4, 8, 4, 8, 1};
  const int t = int(type);
  return t >= 1 && t <= 11 ? sizes[t] : 0;
}

// ---- writer

LsdaWriter::LsdaWriter(const std::string& path)
    : path_(path), file_(std::fopen(path.c_str(), "wb"), std::fclose) {
  if (!file_) throw std::runtime_error("cannot write " + path);
  // lengths and offsets of 8 bytes, commands and types of 1, little endian
  const unsigned char header[8] = {8, 8, 8, 1, 1, 1, 0, 0};
  put(header, 8);
  next_pointer_ = end_ + record_head;
  put_record(first_table, std::string(8, '\0'));
}

LsdaWriter::~LsdaWriter() {
  try {
    flush();
  } catch (const std::exception&) {
    // a destructor cannot report; the caller who cares flushes first
  }
}

void LsdaWriter::put(const void* data, std::size_t bytes) {
  if (std::fwrite(data, 1, bytes, file_.get()) != bytes)
    throw std::runtime_error("cannot write " + path_ + ": disk full?");
  end_ += bytes;
}

void LsdaWriter::put_record(std::uint8_t command, std::string_view payload) {
  std::string head;
  append<std::uint64_t>(head, record_head + payload.size());
  append(head, command);
  put(head.data(), head.size());
  put(payload.data(), payload.size());
}

void LsdaWriter::cd(std::string_view directory) {
  if (directory == directory_) return;
  directory_ = directory;
  put_record(cd_record, directory_);
}

void LsdaWriter::write_raw(std::string_view name, LsdaType type, const void* data,
                           std::uint64_t count) {
  if (name.empty() || name.size() > 255)
    throw std::runtime_error("the name of an LSDA variable has 1 to 255 characters");
  const std::uint64_t size = count * lsda_size(type);
  fresh_.push_back({directory_, std::string(name), type, end_, count});
  std::string head;
  append<std::uint64_t>(head, record_head + 2 + name.size() + size);
  append<std::uint8_t>(head, data_record);
  append<std::uint8_t>(head, std::uint8_t(type));
  append<std::uint8_t>(head, std::uint8_t(name.size()));
  head += name;
  put(head.data(), head.size());
  put(data, size);
}

void LsdaWriter::write_text(std::string_view name, std::string_view text) {
  write_raw(name, LsdaType::i1, text.data(), text.size());
}

void LsdaWriter::write_integers(std::string_view name, const std::vector<std::int64_t>& values) {
  using Limits = std::numeric_limits<std::int32_t>;
  const bool fits = std::all_of(values.begin(), values.end(),
                                [](auto v) { return v >= Limits::min() && v <= Limits::max(); });
  if (!fits) return write_raw(name, LsdaType::i8, values.data(), values.size());
  const std::vector<std::int32_t> narrow(values.begin(), values.end());
  write_raw(name, LsdaType::i4, narrow.data(), narrow.size());
}

void LsdaWriter::write_reals(std::string_view name, const std::vector<double>& values) {
  const std::vector<float> narrow(values.begin(), values.end());
  write_raw(name, LsdaType::r4, narrow.data(), narrow.size());
}

void LsdaWriter::flush() {
  if (!fresh_.empty()) {
    // the table: every directory once, its variables under it
    std::stable_sort(fresh_.begin(), fresh_.end(),
                     [](const Symbol& a, const Symbol& b) { return a.directory < b.directory; });
    std::string table, current;
    auto record = [&](std::uint8_t command, const std::string& payload) {
      append<std::uint64_t>(table, record_head + payload.size());
      append(table, command);
      table += payload;
    };
    for (const Symbol& s : fresh_) {
      if (s.directory != current) record(cd_record, current = s.directory);
      std::string payload = s.name;
      append(payload, std::uint8_t(s.type));
      append(payload, s.offset);
      append(payload, s.count);
      record(variable_record, payload);
    }
    record(end_table, std::string(8, '\0'));

    const std::uint64_t start = end_;
    std::string head;
    append<std::uint64_t>(head, record_head + table.size());
    append<std::uint8_t>(head, begin_table);
    put(head.data(), head.size());
    put(table.data(), table.size());
    fresh_.clear();

    // only now, with the table on file, link it into the chain
    std::fflush(file_.get());
    std::fseek(file_.get(), long(next_pointer_), SEEK_SET);
    std::fwrite(&start, 8, 1, file_.get());
    std::fseek(file_.get(), 0, SEEK_END);
    next_pointer_ = end_ - 8;
    directory_.clear();
  }
  if (std::fflush(file_.get()) != 0)
    throw std::runtime_error("cannot write " + path_ + ": disk full?");
}

// ---- reader

LsdaReader::LsdaReader(const std::string& path)
    : path_(path), file_(std::fopen(path.c_str(), "rb"), std::fclose) {
  if (!file_) throw std::runtime_error("cannot open " + path);
  std::fseek(file_.get(), 0, SEEK_END);
  size_ = std::uint64_t(std::ftell(file_.get()));
  const std::string head = size_ >= 8 ? bytes(0, 8) : std::string(8, '\0');
  header_ = {head[1], head[2], head[3], head[4]};
  const auto width = [](int n) { return n == 1 || n == 2 || n == 4 || n == 8; };
  if (head[0] < 8 || !width(head[1]) || !width(head[2]) || !width(head[3]) || !width(head[4]))
    throw std::runtime_error(path + " is not a binout (LSDA) file");
  swap_ = head[5] == 0;

  // walk the chain of symbol tables; what follows the last one has no index and is scanned
  Record record;
  std::uint64_t position = std::uint64_t(head[0]), unindexed = position;
  if (record_at(position, record) && record.command == first_table) {
    unindexed = position + record.length;
    position = number(record.payload, header_.offset_bytes);
    while (position > 0 && record_at(position, record) && record.command == begin_table) {
      unindexed = position + record.length;
      const std::uint64_t next = read_table(record);
      if (next <= position) break;
      position = next;
    }
  }
  scan(unindexed);
}

std::string LsdaReader::bytes(std::uint64_t position, std::uint64_t count) const {
  if (position > size_ || count > size_ - position)
    throw std::runtime_error(path_ + " ends inside a record");
  std::string out(count, '\0');
  std::fseek(file_.get(), long(position), SEEK_SET);
  if (std::fread(out.data(), 1, count, file_.get()) != count)
    throw std::runtime_error("cannot read " + path_);
  return out;
}

std::uint64_t LsdaReader::number(std::uint64_t position, int count) const {
  const std::string raw = bytes(position, std::uint64_t(count));
  std::uint64_t value = 0;
  for (int i = 0; i < count; ++i)
    value |= std::uint64_t(std::uint8_t(raw[swap_ ? count - 1 - i : i])) << (8 * i);
  return value;
}

bool LsdaReader::record_at(std::uint64_t position, Record& r) const {
  const std::uint64_t head = std::uint64_t(header_.length_bytes + header_.command_bytes);
  if (position + head > size_) return false;
  r.position = position;
  r.length = number(position, header_.length_bytes);
  r.command = int(number(position + header_.length_bytes, header_.command_bytes));
  r.payload = position + head;
  return r.length >= head && r.length <= size_ - position;
}

// The directory reached from another by a path that may be relative and climb with "..".
std::string LsdaReader::enter(const std::string& from, const std::string& path) const {
  std::string out = !path.empty() && path[0] == '/' ? "" : from;
  for (std::size_t i = 0; i < path.size();) {
    const std::size_t end = std::min(path.find('/', i), path.size());
    const std::string name = path.substr(i, end - i);
    if (name == "..")
      out.resize(out.rfind('/') == std::string::npos ? 0 : out.rfind('/'));
    else if (!name.empty() && name != ".")
      out += "/" + name;
    i = end + 1;
  }
  return out;
}

// Adds the variables of one table; returns the position of the next table or 0.
std::uint64_t LsdaReader::read_table(const Record& begin) {
  std::string directory;
  const int entry = header_.type_bytes + header_.offset_bytes + header_.length_bytes;
  Record r;
  for (std::uint64_t at = begin.payload; record_at(at, r); at += r.length) {
    const std::uint64_t size = r.position + r.length - r.payload;
    if (r.command == end_table) return number(r.payload, header_.offset_bytes);
    if (r.command == cd_record) directory = enter(directory, bytes(r.payload, size));
    if (r.command != variable_record || size < std::uint64_t(entry)) continue;
    const std::string name = bytes(r.payload, size - entry);
    const std::uint64_t field = r.payload + size - entry;
    Symbol s;
    s.type = LsdaType(number(field, header_.type_bytes));
    const std::uint64_t offset = number(field + header_.type_bytes, header_.offset_bytes);
    s.count = number(field + header_.type_bytes + header_.offset_bytes, header_.length_bytes);
    // values follow the head of the DATA record: length, command, type, length of name, name
    s.data = offset + header_.length_bytes + header_.command_bytes + header_.type_bytes + 1 +
             name.size();
    if (lsda_size(s.type) == 0 || s.count > size_ || s.data + s.count * lsda_size(s.type) > size_)
      throw std::runtime_error(path_ + ": the symbol table is damaged at " + directory + "/" +
                               name);
    symbols_[directory + "/" + name] = s;
  }
  return 0;
}

// Adds the variables of the records from `position` on. Without a table before, the directory
// starts at "/"; after a table it is known from the first absolute CD on.
void LsdaReader::scan(std::uint64_t position) {
  std::string directory;
  bool known = symbols_.empty();
  Record r;
  for (; record_at(position, r); position += r.length) {
    const std::uint64_t size = r.position + r.length - r.payload;
    if (r.command == cd_record) {
      const std::string path = bytes(r.payload, size);
      known = known || path[0] == '/';
      directory = enter(directory, path);
    }
    if (r.command != data_record || !known || size < std::uint64_t(header_.type_bytes + 1))
      continue;
    Symbol s;
    s.type = LsdaType(number(r.payload, header_.type_bytes));
    const std::uint64_t name_size = number(r.payload + header_.type_bytes, 1);
    if (lsda_size(s.type) == 0 || header_.type_bytes + 1 + name_size > size) continue;
    s.data = r.payload + header_.type_bytes + 1 + name_size;
    s.count = (r.position + r.length - s.data) / lsda_size(s.type);
    symbols_[directory + "/" + bytes(r.payload + header_.type_bytes + 1, name_size)] = s;
  }
}

std::vector<std::string> LsdaReader::list(const std::string& directory) const {
  const std::string prefix =
      directory.empty() || directory.back() != '/' ? directory + "/" : directory;
  std::vector<std::string> out;
  for (auto it = symbols_.lower_bound(prefix); it != symbols_.end(); ++it) {
    if (it->first.compare(0, prefix.size(), prefix) != 0) break;
    std::string name =
        it->first.substr(prefix.size(), it->first.find('/', prefix.size()) - prefix.size());
    if (out.empty() || out.back() != name) out.push_back(std::move(name));
  }
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

const LsdaReader::Symbol& LsdaReader::find(const std::string& path) const {
  const auto it = symbols_.find(path);
  if (it == symbols_.end()) throw std::runtime_error(path_ + " does not hold " + path);
  return it->second;
}

std::string LsdaReader::raw(const std::string& path) const {
  const Symbol& s = find(path);
  return bytes(s.data, s.count * lsda_size(s.type));
}

std::vector<double> LsdaReader::reals(const std::string& path) const {
  const LsdaType type = find(path).type;
  std::string data = raw(path);
  if (const int size = lsda_size(type); swap_ && size > 1)
    for (std::size_t i = 0; i < data.size(); i += size)
      std::reverse(data.begin() + i, data.begin() + i + size);
  return convert<double>(data, type);
}

std::vector<std::int64_t> LsdaReader::integers(const std::string& path) const {
  const LsdaType type = find(path).type;
  std::string data = raw(path);
  if (const int size = lsda_size(type); swap_ && size > 1)
    for (std::size_t i = 0; i < data.size(); i += size)
      std::reverse(data.begin() + i, data.begin() + i + size);
  return convert<std::int64_t>(data, type);
}

std::string LsdaReader::text(const std::string& path) const {
  std::string s = raw(path);
  s.erase(s.find_last_not_of(std::string(" \0", 2)) + 1);
  return s;
}

}  // namespace fabrica

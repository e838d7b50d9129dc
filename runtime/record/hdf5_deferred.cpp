#include "record/hdf5_deferred.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <memory>
#include <new>
#include <string>
#include <type_traits>

#include "record/pending_changes.hpp"

namespace bodeflow::record::h5 {
namespace {

/// The library sees the first member and passes its address to the functions below; they run under `lock`.
struct DeferredFile {
  H5FD_t common{};
  std::string path;
  int file = -1;
  haddr_t held = 0;  ///< bytes of the file when it was opened
  haddr_t end = 0;   ///< bytes of the file now
  haddr_t allocated = 0;
  std::vector<PendingChange> changes;  ///< of bytes that it held, in the order of writing
};

static_assert(std::is_standard_layout_v<DeferredFile>, "the library's address of the first member is ours");

DeferredFile* self_of(H5FD_t* file) { return reinterpret_cast<DeferredFile*>(file); }
const DeferredFile* self_of(const H5FD_t* file) { return reinterpret_cast<const DeferredFile*>(file); }

H5FD_t* open_file(const char* name, unsigned flags, hid_t, haddr_t) {
  const int create = (flags & H5F_ACC_CREAT) != 0 ? O_CREAT : 0, empty = (flags & H5F_ACC_TRUNC) != 0 ? O_TRUNC : 0;
  const int file = ::open(name, O_RDWR | O_CLOEXEC | create | empty, 0666);
  struct stat now {};
  if (file < 0) return nullptr;
  std::unique_ptr<DeferredFile> opened(new (std::nothrow) DeferredFile);
  if (!opened || ::fstat(file, &now) != 0) {
    ::close(file);
    return nullptr;
  }
  opened->path = name;
  opened->file = file;
  opened->held = opened->end = static_cast<haddr_t>(now.st_size);
  return &opened.release()->common;
}

herr_t close_file(H5FD_t* f) {
  const std::unique_ptr<DeferredFile> file(self_of(f));
  const bool written = write_changes(file->path, file->file, file->changes);
  return ::close(file->file) == 0 && written ? 0 : -1;
}

int compare(const H5FD_t* a, const H5FD_t* b) {
  struct stat one {
  }, other{};
  ::fstat(self_of(a)->file, &one);
  ::fstat(self_of(b)->file, &other);
  if (one.st_dev != other.st_dev) return one.st_dev < other.st_dev ? -1 : 1;
  if (one.st_ino != other.st_ino) return one.st_ino < other.st_ino ? -1 : 1;
  return 0;
}

herr_t query(const H5FD_t*, unsigned long* flags) {
  if (flags != nullptr)
    *flags = H5FD_FEAT_AGGREGATE_METADATA | H5FD_FEAT_ACCUMULATE_METADATA | H5FD_FEAT_DATA_SIEVE | H5FD_FEAT_AGGREGATE_SMALLDATA |
             H5FD_FEAT_POSIX_COMPAT_HANDLE | H5FD_FEAT_DEFAULT_VFD_COMPATIBLE;
  return 0;
}

haddr_t get_eoa(const H5FD_t* f, H5FD_mem_t) { return self_of(f)->allocated; }
herr_t set_eoa(H5FD_t* f, H5FD_mem_t, haddr_t address) { return self_of(f)->allocated = address, 0; }
haddr_t get_eof(const H5FD_t* f, H5FD_mem_t) { return self_of(f)->end; }
herr_t get_handle(H5FD_t* f, hid_t, void** handle) { return *handle = &self_of(f)->file, 0; }

herr_t read_bytes(H5FD_t* f, H5FD_mem_t, hid_t, haddr_t address, std::size_t size, void* buffer) {
  const DeferredFile& file = *self_of(f);
  auto* out = static_cast<unsigned char*>(buffer);
  std::size_t have = 0;
  while (have < size) {
    const ssize_t got = ::pread(file.file, out + have, size - have, static_cast<off_t>(address + have));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return -1;
    if (got == 0) break;
    have += static_cast<std::size_t>(got);
  }
  std::memset(out + have, 0, size - have);  // as the library expects beyond the end
  for (const auto& change : file.changes) {
    const haddr_t first = std::max(address, change.address);
    const haddr_t last = std::min(address + size, change.address + change.bytes.size());
    if (first < last) std::memcpy(out + (first - address), change.bytes.data() + (first - change.address), last - first);
  }
  return 0;
}

herr_t write_bytes(H5FD_t* f, H5FD_mem_t, hid_t, haddr_t address, std::size_t size, const void* buffer) {
  DeferredFile& file = *self_of(f);
  const auto* in = static_cast<const unsigned char*>(buffer);
  const std::size_t old = address >= file.held ? 0 : std::min<std::size_t>(size, file.held - address);
  try {
    if (old > 0) file.changes.push_back({address, {in, in + old}});
  } catch (const std::bad_alloc&) {
    return -1;
  }
  if (!write_at(file.file, address + old, in + old, size - old)) return -1;
  file.end = std::max(file.end, address + size);
  return 0;
}

herr_t flush(H5FD_t*, hid_t, hbool_t) { return 0; }

herr_t truncate(H5FD_t* f, hid_t, hbool_t) {
  DeferredFile& file = *self_of(f);
  if (file.allocated == file.end || file.allocated < file.held) return 0;
  if (::ftruncate(file.file, static_cast<off_t>(file.allocated)) != 0) return -1;
  file.end = file.allocated;
  return 0;
}

herr_t lock_file(H5FD_t*, hbool_t) { return 0; }
herr_t unlock_file(H5FD_t*) { return 0; }

H5FD_class_t make_driver() {
  H5FD_class_t driver{};
  driver.name = "bodeflow_deferred";
  driver.maxaddr = (haddr_t{1} << 62U) - 1;
  driver.fc_degree = H5F_CLOSE_WEAK;
  driver.open = open_file;
  driver.close = close_file;
  driver.cmp = compare;
  driver.query = query;
  driver.get_eoa = get_eoa;
  driver.set_eoa = set_eoa;
  driver.get_eof = get_eof;
  driver.get_handle = get_handle;
  driver.read = read_bytes;
  driver.write = write_bytes;
  driver.flush = flush;
  driver.truncate = truncate;
  driver.lock = lock_file;
  driver.unlock = unlock_file;
  const H5FD_mem_t map[H5FD_MEM_NTYPES] = H5FD_FLMAP_DICHOTOMY;
  std::copy(std::begin(map), std::end(map), std::begin(driver.fl_map));
  return driver;
}

}  // namespace

void set_deferred_driver(hid_t file_access) {
  static const H5FD_class_t driver = make_driver();
  static const hid_t id = H5FDregister(&driver);  // for the life of the process
  check(H5Pset_driver(file_access, id, nullptr), "can't set up HDF5");
}

}  // namespace bodeflow::record::h5

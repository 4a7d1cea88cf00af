#include "io/run/commit_driver.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <map>
#include <new>
#include <stdexcept>
#include <vector>

#if __has_include(<H5FDdevelop.h>)  // since HDF5 1.13; before, hdf5.h says it all
    #include <H5FDdevelop.h>
#endif
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace selvage {
namespace {

struct HeldWrite {
    H5FD_mem_t type;
    std::vector<unsigned char> bytes;
};

/// HDF5 sees only `base`, which must come first.
struct CommitFile {
    H5FD_t base;
    int descriptor;
    haddr_t allocated;  ///< End of the space that HDF5 has handed out.
    haddr_t size;       ///< Length of the file on disk.
    haddr_t committed;  ///< Bytes from here on are not referred to by anything on disk.
    std::map<haddr_t, HeldWrite> held;
    int error;  ///< errno of the first write that failed; 0: none. Nothing reaches the disk after it.
};

CommitFile& commit_file(H5FD_t* file) { return *reinterpret_cast<CommitFile*>(file); }
const CommitFile& commit_file(const H5FD_t* file) { return *reinterpret_cast<const CommitFile*>(file); }

bool read_all(const CommitFile& file, haddr_t address, std::size_t size, unsigned char* bytes)
{
    while (size > 0) {
        const ssize_t count = ::pread(file.descriptor, bytes, size, off_t(address));
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) return false;
        if (count == 0) {
            std::memset(bytes, 0, size);
            return true;
        }
        address += haddr_t(count), bytes += count, size -= std::size_t(count);
    }
    return true;
}

bool fail(CommitFile& file, int error)
{
    file.error = error == 0 ? EIO : error;
    return false;
}

bool write_all(CommitFile& file, haddr_t address, std::size_t size, const unsigned char* bytes)
{
    while (size > 0) {
        const ssize_t count = ::pwrite(file.descriptor, bytes, size, off_t(address));
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) return fail(file, count < 0 ? errno : EIO);
        address += haddr_t(count), bytes += count, size -= std::size_t(count);
        file.size = std::max(file.size, address);
    }
    return true;
}

bool set_length(CommitFile& file, haddr_t length)
{
    if (::ftruncate(file.descriptor, off_t(length)) != 0) return fail(file, errno);
    file.size = length;
    return true;
}

// Copies the part of [from, from + size) that lies in [to, to + capacity).
void copy_overlap(haddr_t from, std::size_t size, const unsigned char* source, haddr_t to, std::size_t capacity,
                  unsigned char* target)
{
    const haddr_t first = std::max(from, to), last = std::min(from + size, to + capacity);
    if (first < last) std::memcpy(target + (first - to), source + (first - from), last - first);
}

void hold(CommitFile& file, H5FD_mem_t type, haddr_t address, std::size_t size, const unsigned char* bytes)
{
    // All held pieces agree where they overlap, so that their order on disk is free.
    for (auto& [start, piece] : file.held)
        copy_overlap(address, size, bytes, start, piece.bytes.size(), piece.bytes.data());
    HeldWrite& piece = file.held[address];
    if (piece.bytes.size() < size) piece.bytes.assign(bytes, bytes + size);
    piece.type = type;
}

/// The old and the new bytes of one object in the file.
struct Change {
    haddr_t address;
    std::vector<unsigned char> old;
    const std::vector<unsigned char>& bytes;
};

// Writes what differs in [begin, end) by one call.
bool write_span(CommitFile& file, const Change& change, std::size_t begin, std::size_t end)
{
    end = std::min(end, change.bytes.size());
    while (begin < end && change.old[begin] == change.bytes[begin]) ++begin;
    while (begin < end && change.old[end - 1] == change.bytes[end - 1]) --end;
    return begin >= end || write_all(file, change.address + begin, end - begin, change.bytes.data() + begin);
}

// Writes what differs in short calls: fields of headers and rows of frame columns do not depend on each other.
bool write_fields(CommitFile& file, const Change& change)
{
    constexpr std::size_t length = 64;
    for (std::size_t begin = 0; begin < change.bytes.size(); begin += length)
        if (!write_span(file, change, begin, begin + length)) return false;
    return true;
}

// A node of a chunk index: 24 bytes of header, then key 0, child 0, key 1, child 1, ..., key n, and unused bytes.
struct ChunkNode {
    static constexpr std::size_t header = 24, child = 8, most_children = 64;

    static bool is(const HeldWrite& piece)
    {
        return piece.type == H5FD_MEM_BTREE && piece.bytes.size() > header + most_children * child &&
               std::memcmp(piece.bytes.data(), "TREE\1", 5) == 0;
    }
    static int level(const std::vector<unsigned char>& node) { return node[5]; }
    static std::size_t children(const std::vector<unsigned char>& node) { return node[6] + 256u * node[7]; }
    static std::size_t used(const std::vector<unsigned char>& node)
    {
        const std::size_t key = (node.size() - header - most_children * child) / (most_children + 1);
        return header + children(node) * (key + child) + key;
    }
};

// A node that grows gets its new entry, then the count that covers it, then the key that leads to it. One that
// loses entries, or becomes the parent of its former self, changes by one call; unused bytes follow.
bool write_node(CommitFile& file, const Change& change)
{
    const bool same_node = std::memcmp(change.old.data(), change.bytes.data(), 6) == 0;
    if (same_node && ChunkNode::children(change.bytes) >= ChunkNode::children(change.old)) {
        const std::size_t old_used = ChunkNode::used(change.old);
        return write_span(file, change, old_used, change.bytes.size()) &&
               write_span(file, change, 0, ChunkNode::header) && write_span(file, change, ChunkNode::header, old_used);
    }
    const std::size_t used = ChunkNode::used(change.bytes);
    return write_span(file, change, 0, used) && write_span(file, change, used, change.bytes.size());
}

bool write_piece(CommitFile& file, haddr_t address, const HeldWrite& piece)
{
    Change change{address, std::vector<unsigned char>(piece.bytes.size()), piece.bytes};
    if (!read_all(file, address, change.old.size(), change.old.data())) return fail(file, errno);
    return ChunkNode::is(piece) ? write_node(file, change) : write_fields(file, change);
}

int commit_rank(const HeldWrite& piece)
{
    if (piece.type == H5FD_MEM_SUPER) return 0;
    if (ChunkNode::is(piece)) return 256 - ChunkNode::level(piece.bytes);
    return piece.type == H5FD_MEM_OHDR ? 258 : 257;
}

bool commit(CommitFile& file)
{
    if (file.size < file.allocated && !set_length(file, file.allocated)) return false;
    std::vector<std::pair<haddr_t, const HeldWrite*>> order;
    for (const auto& [address, piece] : file.held) order.emplace_back(address, &piece);
    std::ranges::stable_sort(order, {}, [](const auto& entry) { return commit_rank(*entry.second); });
    for (const auto& [address, piece] : order)
        if (!write_piece(file, address, *piece)) return false;
    file.held.clear();
    file.committed = std::max(file.committed, file.allocated);
    return true;
}

// HDF5 passes no error number on. It is not thread-safe, so that one will do.
int open_error = 0;

H5FD_t* driver_open(const char* name, unsigned flags, hid_t, haddr_t)
{
    int mode = flags & H5F_ACC_RDWR ? O_RDWR : O_RDONLY;
    if (flags & H5F_ACC_TRUNC) mode |= O_TRUNC;
    if (flags & H5F_ACC_CREAT) mode |= O_CREAT;
    if (flags & H5F_ACC_EXCL) mode |= O_EXCL;
    // What is written is never reached through a link: another program could have put it there meanwhile.
    if (mode & O_RDWR) mode |= O_NOFOLLOW;
    const int descriptor = ::open(name, mode | O_CLOEXEC | O_NONBLOCK, 0666);  // waits for no other end of a pipe
    open_error = descriptor < 0 ? errno : 0;
    if (descriptor < 0) return nullptr;
    struct stat status {};
    const bool is_file = ::fstat(descriptor, &status) == 0 && S_ISREG(status.st_mode);
    CommitFile* file = is_file ? new (std::nothrow) CommitFile{} : nullptr;
    if (!file) {
        ::close(descriptor);
        return nullptr;
    }
    file->descriptor = descriptor;
    file->size = file->committed = haddr_t(status.st_size);
    return &file->base;
}

herr_t driver_close(H5FD_t* base)
{
    CommitFile* file = &commit_file(base);
    const int result = ::close(file->descriptor);
    delete file;
    return result;
}

// No aggregation and no accumulation: every object is allocated at the end and written by itself.
herr_t driver_query(const H5FD_t*, unsigned long* flags)
{
    *flags = H5FD_FEAT_DEFAULT_VFD_COMPATIBLE;
    return 0;
}

haddr_t driver_get_eoa(const H5FD_t* file, H5FD_mem_t) { return commit_file(file).allocated; }

herr_t driver_set_eoa(H5FD_t* file, H5FD_mem_t, haddr_t address)
{
    commit_file(file).allocated = address;
    return 0;
}

haddr_t driver_get_eof(const H5FD_t* file, H5FD_mem_t) { return commit_file(file).size; }

herr_t driver_read(H5FD_t* base, H5FD_mem_t, hid_t, haddr_t address, std::size_t size, void* buffer)
{
    const CommitFile& file = commit_file(base);
    auto* bytes = static_cast<unsigned char*>(buffer);
    if (!read_all(file, address, size, bytes)) return -1;
    for (const auto& [start, piece] : file.held)
        copy_overlap(start, piece.bytes.size(), piece.bytes.data(), address, size, bytes);
    return 0;
}

// HDF5 is not told of a failure: several versions end in a segmentation fault when they close a file that could not be
// flushed. After one, what HDF5 writes is held in memory, where it finds it again; see commit_error.
// HDF5 is C: no exception may pass through it.
herr_t driver_write(H5FD_t* base, H5FD_mem_t type, hid_t, haddr_t address, std::size_t size, const void* buffer)
try {
    CommitFile& file = commit_file(base);
    const auto* bytes = static_cast<const unsigned char*>(buffer);
    if (file.error == 0 && address >= file.committed && write_all(file, address, size, bytes)) return 0;
    hold(file, type, address, size, bytes);
    return 0;
} catch (const std::bad_alloc&) {
    return -1;
}

herr_t driver_flush(H5FD_t* base, hid_t, hbool_t)
try {
    CommitFile& file = commit_file(base);
    if (file.error == 0) commit(file);
    return 0;
} catch (const std::bad_alloc&) {
    return -1;
}

herr_t driver_truncate(H5FD_t* base, hid_t, hbool_t closing)
{
    CommitFile& file = commit_file(base);
    const bool change = file.size < file.allocated || (closing && file.size > file.allocated);
    if (file.error == 0 && change) set_length(file, file.allocated);
    return 0;
}

herr_t driver_get_handle(H5FD_t* base, hid_t, void** handle)
{
    *handle = &commit_file(base);
    return 0;
}

const H5FD_class_t& driver_class()
{
    static const H5FD_class_t driver = [] {
        H5FD_class_t c{};
#ifdef H5FD_CLASS_VERSION  // since HDF5 1.13.2
        c.version = H5FD_CLASS_VERSION;
        c.value = 512;  // the first of those that HDF5 leaves to drivers nobody else opens files with
#endif
        c.name = "selvage_commit";
        c.maxaddr = haddr_t(INT64_MAX);
        c.fc_degree = H5F_CLOSE_STRONG;
        c.open = driver_open;
        c.close = driver_close;
        c.query = driver_query;
        c.get_eoa = driver_get_eoa;
        c.set_eoa = driver_set_eoa;
        c.get_eof = driver_get_eof;
        c.get_handle = driver_get_handle;
        c.read = driver_read;
        c.write = driver_write;
        c.flush = driver_flush;
        c.truncate = driver_truncate;
        const H5FD_mem_t map[] = H5FD_FLMAP_DICHOTOMY;
        std::ranges::copy(map, c.fl_map);
        return c;
    }();
    return driver;
}

}  // namespace

void use_commit_driver(hid_t file_access_properties)
{
    static const hid_t driver = H5FDregister(&driver_class());
    if (driver < 0 || H5Pset_driver(file_access_properties, driver, nullptr) < 0)
        throw std::runtime_error("HDF5 does not accept the commit driver");
}

int commit_open_error() { return open_error; }

int commit_error(hid_t file)
{
    void* handle = nullptr;
    if (H5Fget_vfd_handle(file, H5P_DEFAULT, &handle) < 0 || !handle) return EIO;
    return static_cast<const CommitFile*>(handle)->error;
}

}  // namespace selvage

#pragma once
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace selvage {

/// Bytes of a file, in which numbers are little-endian. What lies outside is a fault, never read.
class ByteView {
public:
    explicit ByteView(std::span<const unsigned char> bytes = {}) : bytes_(bytes) {}

    std::size_t size() const { return bytes_.size(); }
    const unsigned char* data() const { return bytes_.data(); }
    /// @throws std::runtime_error if they reach beyond the end, as all below do.
    ByteView part(std::uint64_t first, std::uint64_t count) const;
    ByteView from(std::uint64_t first) const { return part(first, size() < first ? 0 : size() - first); }
    std::uint64_t number(std::uint64_t at, int bytes) const;
    /// The text from here to the next zero byte.
    std::string text(std::uint64_t at) const;
    bool starts_with(std::string_view text) const;

private:
    std::span<const unsigned char> bytes_;
};

/// A message of an object header: one property of a group or dataset.
struct Hdf5Message {
    int type;
    std::vector<unsigned char> bytes;
    ByteView view() const { return ByteView(bytes); }
};

/// Stands where a file has no address.
inline constexpr std::uint64_t no_address = UINT64_MAX;

/// The objects of an HDF5 file in the oldest of its formats (superblock 0, object headers 1, groups with symbol
/// tables), in which this program writes. Files are untrusted, and the HDF5 library is not safe with these: of 40 run
/// files in which a few bytes were changed, one made version 1.10.8 write outside its buffers. So they are read here.
/// Every structure is checked before it is used; faults are std::runtime_error. What is held at a time is at most some
/// ten times the file's size, and reading ends where structures lead in circles.
class Hdf5Objects {
public:
    /// @throws InputError if the file cannot be opened, is not a regular file or not HDF5
    explicit Hdf5Objects(const std::string& path);
    Hdf5Objects(const Hdf5Objects&) = delete;
    Hdf5Objects& operator=(const Hdf5Objects&) = delete;
    ~Hdf5Objects();

    std::uint64_t size() const { return size_; }
    /// Returns the address of the header of an object; no_address if there is none.
    std::uint64_t find(const std::string& path) const;
    std::vector<std::string> members(std::uint64_t group) const;
    std::vector<Hdf5Message> messages(std::uint64_t header) const;
    /// Returns bytes of the file.
    std::vector<unsigned char> block(std::uint64_t address, std::uint64_t count) const;
    /// Returns bytes of the file that belong to its structure.
    std::vector<unsigned char> structure(std::uint64_t address, std::uint64_t count) const;
    /// Returns the first bytes of an object of a global heap, in which texts lie.
    std::string heap_text(std::uint64_t collection, std::uint32_t index, std::uint64_t length) const;
    /// Whether the file, which may have grown, is so long.
    bool holds(std::uint64_t bytes) const;

private:
    struct Entry {
        std::string name, link;  ///< `link` is the path that a soft link names.
        std::uint64_t header;
    };
    std::vector<Entry> entries(std::uint64_t group) const;
    void read_nodes(std::uint64_t address, int level, ByteView heap, std::vector<Entry>& entries) const;
    std::uint64_t find(const std::string& path, int links) const;
    void read_heap(std::uint64_t collection) const;

    int descriptor_;
    mutable std::uint64_t size_ = 0, structure_read_ = 0;
    std::uint64_t root_ = no_address;
    mutable std::uint64_t heap_address_ = no_address;
    mutable std::vector<unsigned char> heap_;
    mutable std::map<std::uint64_t, std::uint64_t> heap_places_;  ///< Of the objects in heap_, by their index.
};

}  // namespace selvage

#include "io/run/hdf5_objects.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <stdexcept>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "io/errors.hpp"

namespace selvage {
namespace {

// Types of header messages that matter here.
enum MessageType { link_info = 2, link = 6, continuation = 16, symbol_table = 17 };

// Of all reading of structure together: finding 40 objects in the smallest of runs takes twice its size.
constexpr std::uint64_t most_structure = 64;        // times the file's size,
constexpr std::uint64_t least_structure = 1 << 20;  // and this at least [bytes]

constexpr int any_level = 256;             // of a group's tree; there is none so high
constexpr std::size_t longest_name = 255;  // of a member; this program's have up to 40

constexpr std::uint64_t object_header = 16;  // of a text in a global heap

constexpr const char* newer_format = "HDF5 of a newer format than runs have: h5repack --low=0 writes the older one";

constexpr std::uint64_t superblock_size = 96, root_header = 64, base_address = 24;

void require(bool sound, const char* what)
{
    if (!sound) throw std::runtime_error(std::string("damaged structure: ") + what);
}

// A link of a newer format, which this program does not write, but which tools make for links to other files.
[[noreturn]] void refuse_new_link(const Hdf5Message& message)
{
    constexpr std::uint64_t external = 64, with_type = 8;
    const ByteView view = message.view();
    if (message.type == link && (view.number(1, 1) & with_type) && view.number(2, 1) == external)
        throw std::runtime_error("a link that leads out of the file");
    throw std::runtime_error("links of a newer format, which may lead out of the file");
}

}  // namespace

ByteView ByteView::part(std::uint64_t first, std::uint64_t count) const
{
    require(first <= bytes_.size() && count <= bytes_.size() - first, "it ends too early");
    return ByteView(bytes_.subspan(std::size_t(first), std::size_t(count)));
}

std::uint64_t ByteView::number(std::uint64_t at, int bytes) const
{
    const ByteView view = part(at, std::uint64_t(bytes));
    std::uint64_t value = 0;
    for (int k = bytes - 1; k >= 0; --k) value = value << 8 | view.bytes_[std::size_t(k)];
    return value;
}

std::string ByteView::text(std::uint64_t at) const
{
    const ByteView view = from(at);
    const auto end = std::ranges::find(view.bytes_, 0);
    require(end != view.bytes_.end(), "a name without end");
    return {view.bytes_.begin(), end};
}

bool ByteView::starts_with(std::string_view text) const
{
    return size() >= text.size() && std::memcmp(data(), text.data(), text.size()) == 0;
}

Hdf5Objects::Hdf5Objects(const std::string& path)
{
    const InputPlace place{path, 0, 0, {}};
    descriptor_ = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);  // waits for no other end of a pipe
    if (descriptor_ < 0) throw InputError(place, errno == ENOENT ? "no file" : std::strerror(errno), "an HDF5 file");
    struct stat status {};
    const bool is_file = ::fstat(descriptor_, &status) == 0 && S_ISREG(status.st_mode);
    size_ = is_file ? std::uint64_t(status.st_size) : 0;
    std::string fault = is_file ? "" : "something that is not a file";
    try {
        if (is_file) {
            const std::vector<unsigned char> first = structure(0, std::min(size_, superblock_size));
            const ByteView view(first);
            if (!view.starts_with("\x89HDF\r\n\x1a\n"))
                fault = "another kind of file";
            else if (view.number(8, 1) != 0 || view.number(13, 2) != 0x808 || view.number(base_address, 8) != 0)
                fault = newer_format;
            else
                root_ = view.number(root_header, 8);
        }
    } catch (const std::runtime_error& damage) {
        fault = damage.what();
    }
    if (fault.empty()) return;
    ::close(descriptor_);
    throw InputError(place, fault, "an HDF5 file");
}

Hdf5Objects::~Hdf5Objects() { ::close(descriptor_); }

bool Hdf5Objects::holds(std::uint64_t bytes) const
{
    struct stat status {};
    if (bytes > size_ && ::fstat(descriptor_, &status) == 0) size_ = std::uint64_t(status.st_size);
    return bytes <= size_;
}

std::vector<unsigned char> Hdf5Objects::block(std::uint64_t address, std::uint64_t count) const
{
    if (address > UINT64_MAX - count || !holds(address + count))
        throw std::runtime_error("damaged structure: " + std::to_string(count) + " bytes at " +
                                 std::to_string(address) + " of a file of " + std::to_string(size_));
    std::vector<unsigned char> bytes(static_cast<std::size_t>(count));
    for (std::size_t done = 0; done < bytes.size();) {
        const ssize_t got = ::pread(descriptor_, bytes.data() + done, bytes.size() - done, off_t(address + done));
        if (got < 0 && errno == EINTR) continue;
        require(got > 0, "it cannot be read");
        done += std::size_t(got);
    }
    return bytes;
}

std::vector<unsigned char> Hdf5Objects::structure(std::uint64_t address, std::uint64_t count) const
{
    std::vector<unsigned char> bytes = block(address, count);
    structure_read_ += count;
    require(structure_read_ <= least_structure + most_structure * size_, "it leads in circles");
    return bytes;
}

std::vector<Hdf5Message> Hdf5Objects::messages(std::uint64_t header) const
{
    constexpr std::uint64_t prefix_size = 16, message_header = 8;
    const std::vector<unsigned char> prefix = structure(header, prefix_size);
    if (ByteView(prefix).starts_with("OHDR")) throw std::runtime_error(newer_format);
    require(ByteView(prefix).number(0, 1) == 1, "an object without header");
    std::vector<Hdf5Message> messages;
    std::vector<std::array<std::uint64_t, 2>> blocks{{header + prefix_size, ByteView(prefix).number(8, 4)}};
    std::uint64_t total = 0;
    for (std::size_t next = 0; next < blocks.size(); ++next) {
        total += std::min(blocks[next][1], size_) + 1;
        require(total <= size_, "an object header larger than the file");
        const std::vector<unsigned char> bytes = structure(blocks[next][0], blocks[next][1]);
        const ByteView view(bytes);
        for (std::uint64_t at = 0; at + message_header <= view.size();) {
            const std::uint64_t size = view.number(at + 2, 2);
            const ByteView body = view.part(at + message_header, size);
            require((view.number(at + 4, 1) & 2) == 0, "a property that is kept elsewhere");
            messages.push_back({int(view.number(at, 2)), {body.data(), body.data() + body.size()}});
            if (messages.back().type == continuation) blocks.push_back({body.number(0, 8), body.number(8, 8)});
            at += message_header + size;
        }
    }
    return messages;
}

std::vector<Hdf5Objects::Entry> Hdf5Objects::entries(std::uint64_t group) const
{
    std::vector<Entry> entries;
    for (const Hdf5Message& message : messages(group)) {
        if (message.type == link_info || message.type == link) refuse_new_link(message);
        if (message.type != symbol_table) continue;
        const std::vector<unsigned char> heap = structure(message.view().number(8, 8), 32);
        require(ByteView(heap).starts_with("HEAP"), "a group without names");
        const std::vector<unsigned char> names = structure(ByteView(heap).number(24, 8), ByteView(heap).number(8, 8));
        read_nodes(message.view().number(0, 8), any_level, ByteView(names), entries);
    }
    return entries;
}

// Reads the entries below a node of a group's tree. Nodes of level 0 lead to lists of entries, which have level -1.
void Hdf5Objects::read_nodes(std::uint64_t address, int level, ByteView heap, std::vector<Entry>& entries) const
{
    constexpr std::uint64_t node_header = 24, leaf_header = 8, entry_size = 40;
    const std::vector<unsigned char> start = structure(address, leaf_header);
    const std::uint64_t count = ByteView(start).number(6, 2);
    if (ByteView(start).starts_with("SNOD")) {
        const std::vector<unsigned char> bytes = structure(address, leaf_header + count * entry_size);
        for (std::uint64_t k = 0; k < count; ++k) {
            constexpr std::uint64_t soft_link = 2;
            const ByteView entry = ByteView(bytes).part(leaf_header + k * entry_size, entry_size);
            const bool soft = entry.number(16, 4) == soft_link;
            entries.push_back({heap.text(entry.number(0, 8)), soft ? heap.text(entry.number(24, 4)) : "",
                               soft ? no_address : entry.number(8, 8)});
            require(entries.back().name.size() <= longest_name && entries.back().link.size() <= longest_name &&
                        entries.size() * entry_size <= size_,
                    "a group with too many or too long names");
        }
        return;
    }
    const int found = int(ByteView(start).number(5, 1));
    require(ByteView(start).starts_with(std::string_view("TREE\0", 5)) && (level == any_level || found == level),
            "a group without members");
    const std::vector<unsigned char> bytes = structure(address, node_header + count * 16);
    for (std::uint64_t k = 0; k < count; ++k)
        read_nodes(ByteView(bytes).number(node_header + 8 + k * 16, 8), found - 1, heap, entries);
}

std::vector<std::string> Hdf5Objects::members(std::uint64_t group) const
{
    std::vector<std::string> names;
    for (const Entry& entry : entries(group)) names.push_back(entry.name);
    return names;
}

std::uint64_t Hdf5Objects::find(const std::string& path) const { return find(path, 0); }

std::uint64_t Hdf5Objects::find(const std::string& path, int links) const
{
    constexpr int most_links = 8;
    require(links <= most_links, "links that lead in circles");
    std::uint64_t header = root_;
    for (std::size_t start = 1; start < path.size();) {
        const std::size_t slash = std::min(path.find('/', start), path.size());
        const std::string name = path.substr(start, slash - start);
        const std::vector<Entry> all = entries(header);
        const auto entry = std::ranges::find(all, name, &Entry::name);
        if (entry == all.end()) return no_address;
        header = entry->link.starts_with('/') ? find(entry->link, links + 1) : entry->header;
        if (header == no_address) return header;
        start = slash + 1;
    }
    return header;
}

// Keeps a collection of the global heap and where each of its objects is.
void Hdf5Objects::read_heap(std::uint64_t collection) const
{
    constexpr std::uint64_t heap_header = 16;
    const std::vector<unsigned char> start = structure(collection, heap_header);
    require(ByteView(start).starts_with("GCOL"), "a text without its place");
    heap_address_ = no_address;
    heap_ = structure(collection, ByteView(start).number(8, 8));
    heap_places_.clear();
    const ByteView heap(heap_);
    for (std::uint64_t at = heap_header; at + object_header <= heap.size();) {
        const std::uint64_t index = heap.number(at, 2), size = heap.number(at + 8, 8);
        if (index == 0 || size > heap.size()) break;  // what is free ends a collection
        heap_places_.try_emplace(index, at);
        at += object_header + (size + 7) / 8 * 8;
    }
    heap_address_ = collection;
}

std::string Hdf5Objects::heap_text(std::uint64_t collection, std::uint32_t index, std::uint64_t length) const
{
    if (collection != heap_address_) read_heap(collection);
    const auto place = heap_places_.find(index);
    require(place != heap_places_.end(), "a text that is not there");
    const std::uint64_t at = place->second;
    const ByteView body = ByteView(heap_).part(at + object_header, ByteView(heap_).number(at + 8, 8));
    require(body.size() >= length, "a text that is shorter than it says");
    return {body.data(), body.data() + length};
}

}  // namespace selvage

#include "io/run/checkpoint.hpp"

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <utility>

#include "io/atomic_file.hpp"
#include "io/content_hash.hpp"
#include "io/errors.hpp"
#include "io/run/hdf5_file.hpp"
#include "io/run/hdf5_reader.hpp"

namespace selvage {
namespace {

constexpr const char* reals = "/reals";
constexpr const char* integers = "/integers";
constexpr const char* words = "/words";
constexpr const char* schema = "selvage-checkpoint-3";
constexpr std::string_view checksum_name = "selvage checksum ";  // then 16 hexadecimal digits: they end the file
constexpr std::size_t checksum_length = checksum_name.size() + 16;

std::string member(const char* group, const std::string& name) { return std::string(group) + "/" + name; }

Checkpoint read_groups(const Hdf5Reader& file)
{
    Checkpoint checkpoint;
    for (const std::string& name : file.members(reals)) checkpoint.reals[name] = file.read_reals(member(reals, name));
    for (const std::string& name : file.members(integers)) {
        const std::vector<std::int64_t> values = file.read_integers(member(integers, name));
        if (!std::ranges::all_of(values, [](std::int64_t value) { return std::in_range<int>(value); }))
            file.refuse(member(integers, name), "a number beyond 32 bits", "integers of 32 bits");
        checkpoint.integers[name].assign(values.begin(), values.end());
    }
    for (const std::string& name : file.members(words)) checkpoint.words[name] = file.text(member(words, name), "text");
    return checkpoint;
}

// What ends a file whose contents up to there are as given, which are read piece by piece.
std::string checksum_of(std::istream& contents, std::uintmax_t size)
{
    ContentHash hash;
    std::string piece(1 << 20, '\0');
    for (std::uintmax_t left = size; left > 0 && contents.good();) {
        contents.read(piece.data(), std::streamsize(std::min<std::uintmax_t>(left, piece.size())));
        hash.add({piece.data(), std::size_t(contents.gcount())});
        left -= std::uintmax_t(contents.gcount());
    }
    return std::string(checksum_name) + hash.text();
}

void append_checksum(const std::string& path)
{
    std::error_code gone;
    const std::uintmax_t size = std::filesystem::file_size(path, gone);
    if (gone) throw WriteError(path, gone.value());
    std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
    const std::string checksum = checksum_of(file, size);
    file.clear();
    file.seekp(0, std::ios::end);
    file << checksum << std::flush;
    if (!file) throw WriteError(path, errno);
}

void require_checksum(const std::string& path)
{
    std::error_code error;
    const InputPlace place{path, 0, 0, {}};
    const char* const expected = "a checkpoint written by this version of selvage";
    if (!std::filesystem::exists(path, error)) throw InputError(place, "no file", expected);
    if (!std::filesystem::is_regular_file(path, error))
        throw InputError(place, "something that is not a file", expected);
    const std::uintmax_t size = std::filesystem::file_size(path, error);
    if (error || size < checksum_length) throw InputError(place, "too short a file", expected);
    std::ifstream file(path, std::ios::binary);
    const std::string checksum = checksum_of(file, size - checksum_length);
    std::string found(checksum_length, ' ');
    if (!file.read(found.data(), std::streamsize(checksum_length)) || !found.starts_with(checksum_name))
        throw InputError(place, "a file without a checksum at its end", expected);
    if (found != checksum)
        throw InputError(place, "contents that do not fit their checksum: the file is damaged", expected);
}

void put(Hdf5File& file, const std::string& name, hid_t type, std::size_t size, const void* values)
{
    const Hdf5Id dataset = file.make_dataset(name, type, {size});
    if (size > 0) require_hdf5(H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values), name);
}

}  // namespace

void write_checkpoint(const std::string& path, const Checkpoint& checkpoint)
{
    TemporaryFile temporary(path);
    {
        Hdf5File file(temporary.name(), Hdf5Access::create);
        for (const char* group : {reals, integers, words}) file.make_group(group);
        for (const auto& [name, values] : checkpoint.reals)
            put(file, member(reals, name), H5T_NATIVE_DOUBLE, values.size(), values.data());
        for (const auto& [name, values] : checkpoint.integers)
            put(file, member(integers, name), H5T_NATIVE_INT, values.size(), values.data());
        for (const auto& [name, word] : checkpoint.words) {
            file.make_group(member(words, name));
            file.set_text(member(words, name), "text", word);
        }
        file.set_text("/", "schema", schema);
        file.close();
    }
    append_checksum(temporary.name());
    temporary.move_into_place();
}

Checkpoint read_checkpoint(const std::string& path)
{
    require_checksum(path);
    const Hdf5Reader file(path);
    const std::vector<std::string> found = file.texts("/", "schema");
    if (found.size() != 1 || found.front() != schema)
        throw InputError({path, 0, 0, {}}, "another kind of HDF5 file", "a checkpoint written by selvage");
    return read_groups(file);
}

}  // namespace selvage

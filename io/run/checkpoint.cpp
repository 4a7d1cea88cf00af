#include "io/run/checkpoint.hpp"

#include <algorithm>
#include <utility>

#include "io/atomic_file.hpp"
#include "io/errors.hpp"
#include "io/run/hdf5_file.hpp"

namespace selvage {
namespace {

constexpr const char* reals = "/reals";
constexpr const char* integers = "/integers";
constexpr const char* words = "/words";
constexpr const char* schema = "selvage-checkpoint-1";

std::string member(const char* group, const std::string& name) { return std::string(group) + "/" + name; }

Checkpoint read_groups(const Hdf5File& file)
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

void protect(Hdf5File& file, const std::string& name, hid_t type, std::size_t size, const void* values)
{
    if (size == 0) {
        file.make_dataset(name, type, {0});
        return;
    }
    const Hdf5Id dataset = file.make_dataset(name, type, {size},
                                             {.compressed = false, .growing = false, .chunk = {size}, .checked = true});
    require_hdf5(H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values), name);
}

}  // namespace

void write_checkpoint(const std::string& path, const Checkpoint& checkpoint)
{
    TemporaryFile temporary(path);
    {
        Hdf5File file(temporary.name(), Hdf5Access::create);
        for (const char* group : {reals, integers, words}) file.make_group(group);
        for (const auto& [name, values] : checkpoint.reals)
            protect(file, member(reals, name), H5T_NATIVE_DOUBLE, values.size(), values.data());
        for (const auto& [name, values] : checkpoint.integers)
            protect(file, member(integers, name), H5T_NATIVE_INT, values.size(), values.data());
        for (const auto& [name, word] : checkpoint.words) {
            file.make_group(member(words, name));
            file.set_text(member(words, name), "text", word);
        }
        file.set_text("/", "schema", schema);
        file.close();
    }
    temporary.move_into_place();
}

Checkpoint read_checkpoint(const std::string& path)
{
    const Hdf5File file(path, Hdf5Access::read);
    const std::vector<std::string> found = file.texts("/", "schema");
    if (found.size() != 1 || found.front() != schema)
        throw InputError({path, 0, 0, {}}, "another kind of HDF5 file", "a checkpoint written by selvage");
    return read_groups(file);
}

}  // namespace selvage

#include "host/run/checkpoint_values.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "io/errors.hpp"

namespace selvage {
namespace {

template <class T>
const std::vector<T>& array_of(const std::map<std::string, std::vector<T>>& arrays, std::string_view name,
                               const CheckpointLoader& loader)
{
    const auto at = arrays.find(std::string(name));
    if (at == arrays.end()) loader.refuse(name, "no such array", "one, in a checkpoint of this version of selvage");
    return at->second;
}

template <class T>
const std::vector<T>& sized(const std::vector<T>& values, std::string_view name, std::size_t size,
                            const CheckpointLoader& loader)
{
    if (values.size() != size)
        loader.refuse(name, fmt::format("{} numbers", values.size()),
                      fmt::format("{} numbers, in a checkpoint of this version of selvage", size));
    return values;
}

}  // namespace

void CheckpointSaver::operator()(std::string_view name, const std::vector<Vec3>& values) const
{
    std::vector<double>& flat = to.reals[std::string(name)];
    flat.clear();
    for (const Vec3& x : values) flat.insert(flat.end(), x.data(), x.data() + 3);
}

void CheckpointLoader::refuse(std::string_view name, const std::string& found, const std::string& expected) const
{
    throw InputError({path, 0, 0, std::string(name)}, found, expected);
}

const std::vector<double>& CheckpointLoader::reals(std::string_view name) const
{
    const std::vector<double>& values = array_of(from.reals, name, *this);
    const auto odd = std::find_if_not(values.begin(), values.end(), [](double value) { return std::isfinite(value); });
    if (odd != values.end()) refuse(name, fmt::format("{} at index {}", *odd, odd - values.begin()), "finite numbers");
    return values;
}

const std::vector<int>& CheckpointLoader::integers(std::string_view name) const
{
    return array_of(from.integers, name, *this);
}

const std::vector<double>& CheckpointLoader::reals(std::string_view name, std::size_t size) const
{
    return sized(reals(name), name, size, *this);
}

const std::vector<int>& CheckpointLoader::integers(std::string_view name, std::size_t size) const
{
    return sized(integers(name), name, size, *this);
}

int CheckpointLoader::integer(std::string_view name, int low, int high) const
{
    const int value = integers(name, 1)[0];
    if (value < low || value > high) refuse(name, fmt::format("{}", value), fmt::format("{} to {}", low, high));
    return value;
}

std::vector<char> CheckpointLoader::flags(std::string_view name, std::size_t size) const
{
    const std::vector<int>& values = integers(name, size);
    for (int value : values)
        if (value != 0 && value != 1) refuse(name, fmt::format("{}", value), "0 or 1");
    return {values.begin(), values.end()};
}

std::vector<Vec3> CheckpointLoader::vectors(std::string_view name) const
{
    const std::vector<double>& flat = reals(name);
    if (flat.size() % 3 != 0) refuse(name, fmt::format("{} numbers", flat.size()), "three for each vector");
    std::vector<Vec3> result(flat.size() / 3);
    for (std::size_t k = 0; k < result.size(); ++k) result[k] = {flat[3 * k], flat[3 * k + 1], flat[3 * k + 2]};
    return result;
}

std::string CheckpointLoader::word(const std::string& name) const
{
    const auto at = from.words.find(name);
    return at == from.words.end() ? std::string() : at->second;
}

}  // namespace selvage

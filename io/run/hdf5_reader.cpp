#include "io/run/hdf5_reader.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <stdexcept>
#include <type_traits>

#include "io/errors.hpp"
#include "io/run/hdf5_filters.hpp"

namespace selvage {
namespace {

enum MessageType {
    dataspace = 1,
    datatype = 3,
    external_files = 7,
    data_layout = 8,
    filter_pipeline = 11,
    attribute_message = 12
};
enum TypeClass { whole_numbers = 0, real_numbers = 1, variable_length = 9 };

constexpr std::uint64_t most_rank = 32;

void require(bool sound, const char* what)
{
    if (!sound) throw std::runtime_error(what);
}

std::uint64_t saturated_product(std::uint64_t a, std::uint64_t b)
{
    return a != 0 && b > UINT64_MAX / a ? UINT64_MAX : a * b;
}

std::uint64_t number_count(const Hdf5Reader::Shape& shape)
{
    std::uint64_t count = 1;
    for (const std::uint64_t extent : shape) count = saturated_product(count, extent);
    return count;
}

std::string shape_text(const Hdf5Reader::Shape& shape)
{
    std::string text;
    for (const std::uint64_t extent : shape)
        text += (text.empty() ? "(" : ", ") + (extent == Hdf5Reader::any ? "any" : std::to_string(extent));
    return text.empty() ? "()" : text + ")";
}

bool fits(const Hdf5Reader::Shape& shape, const Hdf5Reader::Shape& asked)
{
    return std::ranges::equal(shape, asked, [](auto a, auto b) { return a == b || b == Hdf5Reader::any; });
}

Hdf5Reader::Shape shape_in(const ByteView& message)
{
    const std::uint64_t version = message.number(0, 1), rank = message.number(1, 1), first = version == 1 ? 8 : 4;
    require(version == 1 || version == 2, "a shape of a newer format");
    require(rank <= most_rank && (version == 1 || message.number(3, 1) != 2), "no shape");
    Hdf5Reader::Shape shape;
    for (std::uint64_t axis = 0; axis < rank; ++axis) shape.push_back(message.number(first + 8 * axis, 8));
    return shape;
}

// The types that this program writes: two's complement and IEEE 754, little-endian, of 4 or 8 bytes.
Hdf5Reader::Number number_in(const ByteView& type)
{
    const int kind = int(type.number(0, 1) & 15), bytes = int(type.number(4, 4));
    const std::uint64_t bits = type.number(1, 3), precision = 8 * std::uint64_t(bytes);
    require((kind == whole_numbers || kind == real_numbers) && (bytes == 4 || bytes == 8), "another type of data");
    bool known = type.number(8, 2) == 0 && type.number(10, 2) == precision;
    if (kind == whole_numbers) known = known && bits == 8;  // signed
    if (kind == real_numbers) {
        // Byte order, normalisation and sign; then place and size of exponent and mantissa, and the bias.
        const std::uint64_t layout = bytes == 4 ? 0x17000817 : 0x34000b34, bias = bytes == 4 ? 127 : 1023;
        known = known && bits == (0x20 | (precision - 1) << 8) && type.number(12, 4) == layout &&
                type.number(16, 4) == bias;
    }
    require(known, "numbers of another kind than 32 or 64 bits, little-endian");
    return {kind == real_numbers, bytes};
}

std::vector<int> filters_in(const ByteView& message)
{
    const std::uint64_t version = message.number(0, 1), count = message.number(1, 1);
    require(version == 1 || version == 2, "filters of a newer format");
    std::vector<int> filters;
    std::uint64_t at = version == 1 ? 8 : 2;
    for (std::uint64_t k = 0; k < count; ++k) {
        filters.push_back(int(message.number(at, 2)));
        require(is_known_filter(filters.back()), "an unknown filter");
        const std::uint64_t name = version == 1 ? message.number(at + 2, 2) : 0;
        const std::uint64_t values = message.number(at + (version == 1 ? 6 : 4), 2);
        at += (version == 1 ? 8 : 6) + (name + 7) / 8 * 8 + 4 * (values + (version == 1 ? values % 2 : 0));
    }
    return filters;
}

// Returns the first message of a type, or null.
const Hdf5Message* first_of(const std::vector<Hdf5Message>& messages, int type)
{
    const auto at = std::ranges::find(messages, type, &Hdf5Message::type);
    return at == messages.end() ? nullptr : &*at;
}

template <class Value>
Value value_at(const unsigned char* bytes, const Hdf5Reader::Number& number)
{
    std::uint64_t bits = 0;
    for (int k = number.bytes - 1; k >= 0; --k) bits = bits << 8 | bytes[k];
    if (number.real && number.bytes == 4) return Value(std::bit_cast<float>(std::uint32_t(bits)));
    if (number.real) return Value(std::bit_cast<double>(bits));
    return number.bytes == 4 ? Value(std::int32_t(bits)) : Value(std::int64_t(bits));
}

}  // namespace

/// An attribute: its type, shape, and bytes.
struct Hdf5Reader::Attribute {
    std::vector<unsigned char> type, data;
    Shape shape;
    bool found = false;
};

std::uint64_t Hdf5Reader::Dataset::row_bytes() const
{
    const Shape row(shape.begin() + (shape.empty() ? 0 : 1), shape.end());
    return saturated_product(number_count(row), std::uint64_t(number.bytes));
}

void Hdf5Reader::refuse(const std::string& object, std::string_view found, std::string_view expected) const
{
    throw InputError({path_, 0, 0, object}, found, expected);
}

template <class Act>
auto Hdf5Reader::guarded(const std::string& object, const Act& act) const
{
    try {
        return act();
    } catch (const InputError&) {
        throw;
    } catch (const std::runtime_error& fault) {
        refuse(object, fault.what(), "what selvage writes there");
    }
}

bool Hdf5Reader::exists(const std::string& object) const
{
    return guarded(object, [&] { return objects_.find(object) != no_address; });
}

std::vector<std::string> Hdf5Reader::members(const std::string& group) const
{
    return guarded(group, [&] {
        const std::uint64_t header = objects_.find(group);
        require(header != no_address, "nothing");
        std::vector<std::string> names = objects_.members(header);
        std::ranges::sort(names);
        return names;
    });
}

std::vector<Hdf5Message> Hdf5Reader::messages(const std::string& object) const
{
    const std::uint64_t header = objects_.find(object);
    require(header != no_address, "nothing");
    return objects_.messages(header);
}

Hdf5Reader::Shape Hdf5Reader::shape(const std::string& name) const
{
    return guarded(name, [&] {
        for (const Hdf5Message& message : messages(name))
            if (message.type == dataspace) return shape_in(message.view());
        throw std::runtime_error("no data set");
    });
}

Hdf5Reader::Dataset Hdf5Reader::open(const std::string& name, bool with_chunks) const
{
    return guarded(name, [&] {
        Dataset dataset;
        dataset.name = name;
        const std::vector<Hdf5Message> all = messages(name);
        const Hdf5Message *space = first_of(all, dataspace), *type = first_of(all, datatype),
                          *layout = first_of(all, data_layout);
        require(!first_of(all, external_files), "external storage: its data lie in another file");
        require(space && type && layout, "no data set");
        dataset.shape = shape_in(space->view());
        dataset.number = number_in(type->view());
        if (const Hdf5Message* filters = first_of(all, filter_pipeline)) dataset.filters = filters_in(filters->view());
        read_chunks(layout->view(), dataset, with_chunks);
        return dataset;
    });
}

void Hdf5Reader::read_chunks(const ByteView& layout, Dataset& dataset, bool with_chunks) const
{
    enum Layout { contiguous = 1, chunked = 2, virtual_data = 3 };
    const std::uint64_t version = layout.number(0, 1), kind = layout.number(1, 1);
    require(version != 4 || kind != virtual_data, "a virtual data set, which may lead out of the file");
    require(version == 3 && (kind == contiguous || kind == chunked), "storage of another kind");
    const std::uint64_t rows = dataset.shape.empty() ? 1 : dataset.shape[0];
    if (kind == contiguous) {
        const std::uint64_t bytes = saturated_product(rows, dataset.row_bytes());
        dataset.chunk_rows = rows;
        const std::uint64_t address = layout.number(2, 8);
        if (address != no_address && bytes > 0 && layout.number(10, 8) >= bytes) {
            dataset.chunks.push_back({0, address, bytes, 0});
            dataset.stored = bytes;
        }
        return;
    }
    Shape chunk;
    const std::uint64_t rank = layout.number(2, 1);
    for (std::uint64_t axis = 0; axis < rank; ++axis) chunk.push_back(layout.number(11 + 4 * axis, 4));
    require(rank == dataset.shape.size() + 1 && rank > 1 && chunk[0] > 0, "chunks of another rank");
    require(std::equal(chunk.begin() + 1, chunk.end() - 1, dataset.shape.begin() + 1, dataset.shape.end()) &&
                chunk.back() == std::uint64_t(dataset.number.bytes),
            "chunks that are not whole rows");
    dataset.chunk_rows = chunk[0];
    if (const std::uint64_t tree = layout.number(3, 8); with_chunks && tree != no_address)
        read_chunk_nodes(tree, 256, dataset, chunk);
    std::ranges::sort(dataset.chunks, {}, &Chunk::first_row);
    for (const Chunk& chunk : dataset.chunks) dataset.stored += chunk.bytes;
    require(objects_.holds(dataset.stored), "damaged structure: chunks that overlap");
}

// Reads the chunks below a node; level 256: the root, of any level.
void Hdf5Reader::read_chunk_nodes(std::uint64_t address, int level, Dataset& dataset, const Shape& chunk) const
{
    const std::uint64_t header = 24, key = 8 + 8 * chunk.size(), entry = key + 8;
    const std::vector<unsigned char> start = objects_.structure(address, header);
    require(ByteView(start).starts_with(std::string_view("TREE\1", 5)), "damaged structure: no index of chunks");
    const int found = int(ByteView(start).number(5, 1));
    require(level == 256 || found == level, "damaged structure: an index of chunks with wrong levels");
    const std::uint64_t count = ByteView(start).number(6, 2);
    const std::vector<unsigned char> bytes = objects_.structure(address + header, count * entry);
    for (std::uint64_t k = 0; k < count; ++k) {
        const ByteView view = ByteView(bytes).part(k * entry, entry);
        const std::uint64_t child = view.number(key, 8);
        if (found > 0) {
            read_chunk_nodes(child, found - 1, dataset, chunk);
            continue;
        }
        const std::uint64_t stored = view.number(0, 4);
        require(stored <= size() && view.number(8, 8) % dataset.chunk_rows == 0, "damaged structure: a wrong chunk");
        dataset.chunks.push_back({view.number(8, 8), child, stored, std::uint32_t(view.number(4, 4))});
        require(dataset.chunks.size() <= size(), "damaged structure: more chunks than the file can hold");
    }
}

const Hdf5Reader::Chunk* Hdf5Reader::chunk_of(const Dataset& dataset, std::uint64_t row)
{
    const std::uint64_t first = row - row % std::max<std::uint64_t>(1, dataset.chunk_rows);
    const auto at = std::ranges::lower_bound(dataset.chunks, first, {}, &Chunk::first_row);
    return at != dataset.chunks.end() && at->first_row == first ? &*at : nullptr;
}

std::vector<unsigned char> Hdf5Reader::stored_bytes(const Dataset& dataset, const Chunk& chunk) const
{
    return guarded(dataset.name, [&] { return objects_.block(chunk.address, chunk.bytes); });
}

std::vector<unsigned char> Hdf5Reader::rows_of(const Dataset& dataset, std::uint64_t first, std::uint64_t rows,
                                               bool counted) const
{
    const bool compressed = std::ranges::count(dataset.filters, int(deflate_filter)) > 0;
    const std::uint64_t row = dataset.row_bytes(), bytes = saturated_product(rows, row);
    if (bytes == 0) return {};
    const std::uint64_t stored = std::min(dataset.stored, size());
    const std::uint64_t whole = saturated_product(dataset.chunk_rows, row);
    const std::uint64_t of_stored = saturated_product(stored, compressed ? most_deflation : 1);
    const std::uint64_t all = saturated_product(most_expansion, size());
    const std::uint64_t left = all - std::min(all, counted ? bytes_read_ : 0);
    if (const std::uint64_t most = std::min(of_stored, left); std::max(bytes, whole) > most)
        refuse(
            dataset.name,
            std::to_string(std::max(bytes, whole)) + " bytes of values in " + std::to_string(stored) + " stored bytes",
            "at most " + std::to_string(most) + " bytes");
    if (counted) bytes_read_ += bytes;
    std::vector<unsigned char> values(static_cast<std::size_t>(bytes));
    for (std::uint64_t at = first; at < first + rows;) {
        const Chunk* chunk = chunk_of(dataset, at);
        require(chunk, "values that are not stored");
        require(chunk->skipped_filters == 0, "a chunk without some of its filters");
        const std::vector<unsigned char> piece =
            unfiltered(counted ? objects_.structure(chunk->address, chunk->bytes) : stored_bytes(dataset, *chunk),
                       dataset.filters, std::size_t(dataset.number.bytes), std::size_t(whole));
        const std::uint64_t end = std::min(chunk->first_row + dataset.chunk_rows, first + rows);
        std::memcpy(values.data() + (at - first) * row, piece.data() + (at - chunk->first_row) * row, (end - at) * row);
        at = end;
    }
    return values;
}

std::vector<double> Hdf5Reader::read_reals(const Dataset& dataset, std::uint64_t first, std::uint64_t rows,
                                           bool counted) const
{
    return guarded(dataset.name, [&] {
        const std::vector<unsigned char> bytes = rows_of(dataset, first, rows, counted);
        std::vector<double> values(bytes.size() / std::size_t(dataset.number.bytes));
        for (std::size_t k = 0; k < values.size(); ++k)
            values[k] = value_at<double>(bytes.data() + k * std::size_t(dataset.number.bytes), dataset.number);
        return values;
    });
}

template <class Value>
std::vector<Value> Hdf5Reader::read(const std::string& name, const Shape& shape, std::uint64_t rows) const
{
    const Shape found = this->shape(name);
    const bool too_short = rows != any && (found.empty() || found[0] < rows);
    if ((!shape.empty() && !fits(found, shape)) || too_short)
        refuse(name, "shape " + shape_text(found),
               "shape " + shape_text(shape) + (too_short ? ", at least " + std::to_string(rows) + " rows" : ""));
    return guarded(name, [&] {
        const Dataset dataset = open(name, rows > 0 && number_count(found) > 0);
        require(std::is_floating_point_v<Value> || !dataset.number.real, "real numbers instead of whole ones");
        const std::uint64_t all = dataset.shape.empty() ? 1 : dataset.shape[0];
        const std::vector<unsigned char> bytes = rows_of(dataset, 0, std::min(rows, all), true);
        std::vector<Value> values(bytes.size() / std::size_t(dataset.number.bytes));
        for (std::size_t k = 0; k < values.size(); ++k)
            values[k] = value_at<Value>(bytes.data() + k * std::size_t(dataset.number.bytes), dataset.number);
        return values;
    });
}

std::vector<double> Hdf5Reader::read_reals(const std::string& name, const Shape& shape, std::uint64_t rows) const
{
    return read<double>(name, shape, rows);
}

std::vector<std::int64_t> Hdf5Reader::read_integers(const std::string& name, const Shape& shape,
                                                    std::uint64_t rows) const
{
    return read<std::int64_t>(name, shape, rows);
}

std::vector<int> Hdf5Reader::read_indices(const std::string& name, const Shape& shape, std::int64_t count,
                                          const char* what) const
{
    const std::vector<std::int64_t> values = read_integers(name, shape);
    const auto wrong = std::ranges::find_if(values, [&](std::int64_t value) { return value < 0 || value >= count; });
    if (wrong != values.end()) {
        const std::size_t width = shape.size() > 1 ? shape.back() : 1,
                          row = std::size_t(wrong - values.begin()) / width;
        refuse(name + "[" + std::to_string(row) + "]", what + (" " + std::to_string(*wrong)),
               "one of the " + std::to_string(count) + " from 0 to " + std::to_string(count - 1));
    }
    return {values.begin(), values.end()};
}

Hdf5Reader::Attribute Hdf5Reader::attribute(const std::string& object, const char* name) const
{
    Attribute attribute;
    for (const Hdf5Message& message : messages(object)) {
        if (message.type != attribute_message) continue;
        const ByteView view = message.view();
        const std::uint64_t version = view.number(0, 1), padding = version == 1 ? 8 : 1;
        require(version >= 1 && version <= 3, "an attribute of a newer format");
        require(version == 1 || view.number(1, 1) == 0, "an attribute whose type is kept elsewhere");
        const auto padded = [&](std::uint64_t size) { return (size + padding - 1) / padding * padding; };
        const std::uint64_t start = version == 3 ? 9 : 8, type = start + padded(view.number(2, 2)),
                            space = type + padded(view.number(4, 2)), data = space + padded(view.number(6, 2));
        if (view.text(start) != name) continue;
        const ByteView type_view = view.part(type, view.number(4, 2)), data_view = view.from(data);
        attribute.type.assign(type_view.data(), type_view.data() + type_view.size());
        attribute.shape = shape_in(view.part(space, view.number(6, 2)));
        attribute.data.assign(data_view.data(), data_view.data() + data_view.size());
        attribute.found = true;
    }
    return attribute;
}

// A dataset in one piece, whose values are not numbers: more texts than an attribute can hold.
Hdf5Reader::Attribute Hdf5Reader::unfiltered_dataset(const std::string& name) const
{
    Attribute held;
    if (!exists(name)) return held;
    const std::vector<Hdf5Message> all = messages(name);
    const Hdf5Message *space = first_of(all, dataspace), *type = first_of(all, datatype),
                      *layout = first_of(all, data_layout);
    require(!first_of(all, external_files), "external storage: its data lie in another file");
    require(space && type && layout, "no data set");
    constexpr int version = 3, contiguous = 1;
    const ByteView view = layout->view();
    require(view.number(0, 1) == version && view.number(1, 1) == contiguous, "storage of another kind");
    held.shape = shape_in(space->view());
    held.type = type->bytes;
    held.data = objects_.structure(view.number(2, 8), view.number(10, 8));
    held.found = true;
    return held;
}

// A single number of a type.
template <class Value>
Value Hdf5Reader::single(const std::string& object, const char* name) const
{
    const std::string place = object + "@" + name;
    return guarded(place, [&] {
        const Attribute held = attribute(object, name);
        require(held.found, "nothing");
        if (number_count(held.shape) != 1) refuse(place, "shape " + shape_text(held.shape), "a single number");
        const Number number = number_in(ByteView(held.type));
        require(number.real == std::is_floating_point_v<Value>, "another type of data");
        return value_at<Value>(ByteView(held.data).part(0, std::uint64_t(number.bytes)).data(), number);
    });
}

std::int64_t Hdf5Reader::integer(const std::string& object, const char* name) const
{
    return single<std::int64_t>(object, name);
}

double Hdf5Reader::real(const std::string& object, const char* name) const { return single<double>(object, name); }

std::string Hdf5Reader::text(const std::string& object, const char* name) const
{
    const std::vector<std::string> all = texts(object, name);
    if (all.size() != 1) refuse(object + "@" + name, std::to_string(all.size()) + " texts", "one text");
    return all.front();
}

std::vector<std::string> Hdf5Reader::texts(const std::string& object, const char* name) const
{
    return guarded(object + "@" + name, [&] {
        constexpr std::uint64_t reference = 16;  // length, collection and index of a text
        Attribute held = attribute(object, name);
        if (!held.found) held = unfiltered_dataset(object + "/" + name);
        std::vector<std::string> result;
        if (!held.found) return result;
        const ByteView type(held.type), data(held.data);
        require((type.number(0, 1) & 15) == variable_length && (type.number(1, 1) & 15) == 1, "another type of data");
        const std::uint64_t count = number_count(held.shape);
        require(count <= data.size() / reference, "more texts than are stored");
        for (std::uint64_t k = 0; k < count; ++k) {
            const ByteView place = data.part(k * reference, reference);
            const std::uint64_t length = place.number(0, 4), collection = place.number(4, 8);
            bytes_read_ += length + sizeof(std::string);
            require(bytes_read_ <= saturated_product(most_expansion, size()), "texts longer than the file can hold");
            if (length == 0) {
                result.emplace_back();
                continue;
            }
            const std::string text = objects_.heap_text(collection, std::uint32_t(place.number(12, 4)), length);
            result.push_back(text.substr(0, text.find('\0')));
        }
        return result;
    });
}

}  // namespace selvage

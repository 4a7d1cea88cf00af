#include "io/run/xdmf.hpp"

#include <fmt/format.h>

#include "io/atomic_file.hpp"

namespace selvage {
namespace {

std::string escaped(const std::string& text)
{
    std::string result;
    for (const char c : text) {
        if (c == '&')
            result += "&amp;";
        else if (c == '<')
            result += "&lt;";
        else if (c == '>')
            result += "&gt;";
        else if (c == '"')
            result += "&quot;";
        else
            result += c;
    }
    return result;
}

// The rows of a frame are given twice, for the two readers that ParaView and VTK have. Xdmf 3 goes by ItemType, which
// is absent, and reads what the text addresses. Xdmf 2 goes by Type as well: a HyperSlab of (start, stride, count) and
// of an array. Xdmf 3 reads such a HyperSlab as if its first axis ran fastest, and Xdmf 2 does not know the form with
// bars.
std::string frame_text(const XdmfIndex& index, const std::string& hdf5, std::size_t frame)
{
    const long long points = index.point_count, rows = points * (long long)(index.times.size());
    return fmt::format(R"(      <Grid Name="frame {0}" GridType="Uniform">
        <Time Value="{1}"/>
        <Topology TopologyType="Triangle" NumberOfElements="{2}">
          <DataItem Format="HDF" NumberType="Int" Precision="8" Dimensions="{4}">)"
                       R"({3}:/VTKHDF/Polygons/Connectivity</DataItem>
        </Topology>
        <Geometry GeometryType="XYZ">
          <DataItem Type="HyperSlab" Format="HDF" NumberType="Float" Precision="4" Dimensions="{5} 3">)"
                       R"({3}:/VTKHDF/Points|{6} 0:1 1:{5} 3:{7} 3
            <DataItem Format="XML" NumberType="Int" Dimensions="3 2">{6} 0 1 1 {5} 3</DataItem>
            <DataItem Format="HDF" NumberType="Float" Precision="4" Dimensions="{7} 3">{3}:/VTKHDF/Points</DataItem>
          </DataItem>
        </Geometry>
        <Attribute Name="panel" AttributeType="Scalar" Center="Node">
          <DataItem Format="HDF" NumberType="Int" Precision="4" Dimensions="{5}">{3}:/VTKHDF/PointData/panel</DataItem>
        </Attribute>
      </Grid>
)",
                       frame, index.times[frame], index.triangle_count, hdf5, 3LL * index.triangle_count, points,
                       points * (long long)(frame), rows);
}

}  // namespace

std::string xdmf_text(const XdmfIndex& index)
{
    const std::string hdf5 = escaped(index.hdf5_name);
    std::string text = R"(<?xml version="1.0" encoding="utf-8"?>
<Xdmf Version="3.0">
  <Domain>
    <Grid Name="run" GridType="Collection" CollectionType="Temporal">
)";
    for (std::size_t frame = 0; frame < index.times.size(); ++frame) text += frame_text(index, hdf5, frame);
    return text + "    </Grid>\n  </Domain>\n</Xdmf>\n";
}

void write_xdmf(const std::string& path, const XdmfIndex& index) { write_file_atomically(path, xdmf_text(index)); }

}  // namespace selvage

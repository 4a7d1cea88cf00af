#pragma once
#include <hdf5.h>

namespace selvage {

/// Makes HDF5 write in an order that survives a kill at any moment.
///
/// HDF5 updates a file in place and in no particular order, so that a process killed during a flush can leave
/// an index that points nowhere. Below this driver a file on disk changes as follows:
///   1. bytes beyond the end of the last commit are written at once: nothing on disk refers to them yet;
///   2. changes of older bytes are held in memory until H5Fflush or H5Fclose, which write the superblock (the
///      file has its new length by then), then B-tree nodes from the root down (a parent finds the new half of
///      a split node before the old half loses its entries), then data, then object headers by address;
///   3. within one object only the bytes that differ are written; in a B-tree node first the new entry, then the
///      count that covers it, then the key that leads to it.
/// Each such write is at most some hundred bytes long, and the file is readable before and after each of them.
/// The order holds while space is never freed: open a closed file, then only append.
/// The driver takes no file lock, so that a running file can be read.
/// @throws std::runtime_error if HDF5 refuses the driver.
void use_commit_driver(hid_t file_access_properties);

}  // namespace selvage

// Writes grids by NanoVDB 32.9, without OpenVDB: zipped, and as they lie in memory. See make.py.
#define NANOVDB_USE_ZIP
#include <nanovdb/io/IO.h>
#include <nanovdb/tools/CreateNanoGrid.h>
#include <nanovdb/tools/GridBuilder.h>

int main()
{
    nanovdb::tools::build::Grid<float> grid(0.0f, "density", nanovdb::GridClass::FogVolume);
    grid.setTransform(0.5, nanovdb::Vec3d(1, 2, 3));
    auto voxels = grid.getAccessor();
    for (int n = 0; n < 27; ++n) {
        voxels.setValue(nanovdb::Coord(n % 3 + 7, n / 3 % 3, n / 9 - 20), float(n * n % 8) / 4 + 0.125f);
    }
    const auto handle = nanovdb::tools::createNanoGrid(grid);
    nanovdb::io::writeGrid("later.nvdb", handle, nanovdb::io::Codec::ZIP);
    const auto codes = nanovdb::tools::createNanoGrid<nanovdb::tools::build::Grid<float>, nanovdb::Fp8>(grid);
    nanovdb::io::writeGrid("later-fp8.nvdb", codes, nanovdb::io::Codec::ZIP);
}

//! Free space, geodesics and cells.

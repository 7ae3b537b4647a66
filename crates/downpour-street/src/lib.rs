#![doc = include_str!("../README.md")]

mod car;
mod dice;
mod error;
mod furniture;
mod gltf;
mod ground;
mod house;
mod material;
mod mesh;
mod model;
mod noise;
mod raster;
mod settings;
mod street;
mod textures;
mod tree;

pub use car::Car;
pub use error::StreetError;
pub use gltf::{File, TimeOfDay};
pub use ground::Hollow;
pub use material::Material;
pub use mesh::{Mesh, Part, Vertex};
pub use model::{Lamp, Piece, Placement};
pub use settings::{
    LampEra, MAX_CARRIAGEWAY_M, MAX_LENGTH_M, MAX_PAVEMENT_M, MIN_CARRIAGEWAY_M, MIN_LENGTH_M,
    MIN_PAVEMENT_M, Paving, StreetSettings,
};
pub use street::{Doorway, EmissiveSurface, ParkedCar, Street};
pub use textures::{TextureFile, puddle_mask, textures};

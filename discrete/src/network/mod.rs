//! The discrete layer of the robot network: identities, roles, phases and the small protocols by
//! which robots agree. Nothing here knows a coordinate, a clock or a medium.

pub mod activity;
pub mod agreement;
pub mod attachment;
pub mod attendance;
pub mod bulletin;
pub mod confirmation;
pub mod consent;
pub mod control;
pub mod election;
pub mod exchange;
mod id_set;
pub mod lineage;
pub mod offers;
pub mod path;
pub mod post;
pub mod reservation;
mod role;
#[cfg(feature = "serde")]
mod serialization;
pub mod service;
pub mod tables;

pub use activity::{Activity, DUTIES, DutyEvent};
pub use agreement::Agreement;
pub use attachment::{ATTACHMENT, Attachment, AttachmentEvent};
pub use attendance::{ATTENDANCE, Attendance, AttendanceEvent};
pub use bulletin::{Bulletin, NoticeId};
pub use confirmation::Confirmation;
pub use control::{CONTROL, ROUNDS, Round, RoundEvent, Stage, StageEvent};
pub use election::{Bid, Election};
pub use exchange::{EXCHANGE, ExchangeEvent, ExchangeStage};
pub use id_set::IdSet;
pub use lineage::Lineage;
pub use offers::{Offer, Offers, Reply};
pub use path::{Hop, Path, Subgroup};
pub use post::{Anchor, Post, PostId, PostKind};
pub use role::{Phase, Role};
pub use service::{REQUESTS, Request, RequestEvent, SERVICE, Service, ServiceEvent};
pub use tables::{MISSION, MissionStep};

/// A node of the network: robots are numbered first, from 0, then access points, last the user.
pub type NodeId = usize;

//! Points at the same place: they share one vertex of the mesh.

use super::face::NONE;

/// Groups of points that coincide on the coordinate grid. Takes no memory until there is one.
#[derive(Clone, Debug, Default)]
pub struct Coincidences {
    /// Members of each group; the first is the vertex of the mesh. Dissolved groups are empty.
    groups: Vec<Vec<u32>>,
    dissolved: Vec<u32>,
    /// Group and place in the group of each point; empty while there are no groups.
    membership: Vec<(u32, u32)>,
}

/// What leaving a group means for the mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Departure {
    /// The point was alone: its vertex goes.
    Vertex,
    /// Another point stands for the place: nothing changes.
    Duplicate,
    /// The point stood for the place and hands it on to this one.
    Heir(u32),
}

const ALONE: (u32, u32) = (NONE, NONE);

impl Coincidences {
    /// The vertex of the mesh that stands for `point`: itself, unless it is a duplicate.
    #[inline]
    pub fn vertex(&self, point: u32) -> u32 {
        match self.membership.get(point as usize) {
            None | Some(&ALONE) => point,
            Some(&(group, _)) => self.groups[group as usize][0],
        }
    }

    /// Whether several points lie where `vertex` is.
    #[inline]
    pub fn is_shared(&self, vertex: u32) -> bool {
        self.membership.get(vertex as usize).is_some_and(|&membership| membership != ALONE)
    }

    /// The points at the place of `vertex` when there are several, itself first; or none.
    #[cfg(test)]
    pub fn members(&self, vertex: u32) -> &[u32] {
        match self.membership.get(vertex as usize) {
            None | Some(&ALONE) => &[],
            Some(&(group, _)) => &self.groups[group as usize],
        }
    }

    /// The points that share a place with others.
    pub fn shared(&self) -> impl Iterator<Item = u32> {
        self.groups.iter().flatten().copied()
    }

    /// More than the number of any point that shares a vertex.
    pub fn index_bound(&self) -> usize {
        self.membership.len()
    }

    /// Number of points that share the vertex of another one.
    pub fn duplicate_count(&self) -> usize {
        self.groups.iter().map(|group| group.len().saturating_sub(1)).sum()
    }

    /// Notes that `point` lies where `vertex` is.
    pub fn join(&mut self, point: u32, vertex: u32) {
        let len = self.membership.len().max(point.max(vertex) as usize + 1);
        self.membership.resize(len, ALONE);
        if self.membership[vertex as usize] == ALONE {
            let group = self.dissolved.pop().unwrap_or_else(|| {
                self.groups.push(Vec::new());
                self.groups.len() as u32 - 1
            });
            self.enter(group, vertex);
        }
        self.enter(self.membership[vertex as usize].0, point);
    }

    fn enter(&mut self, group: u32, point: u32) {
        let members = &mut self.groups[group as usize];
        self.membership[point as usize] = (group, members.len() as u32);
        members.push(point);
    }

    /// Takes `point` out of its group, if it is in one.
    pub fn leave(&mut self, point: u32) -> Departure {
        let (group, place) = match self.membership.get(point as usize) {
            None | Some(&ALONE) => return Departure::Vertex,
            Some(&membership) => membership,
        };
        self.membership[point as usize] = ALONE;
        let members = &mut self.groups[group as usize];
        members.swap_remove(place as usize);
        if let Some(&moved) = members.get(place as usize) {
            self.membership[moved as usize].1 = place;
        }
        let heir = members[0];
        if members.len() == 1 {
            members.clear();
            self.membership[heir as usize] = ALONE;
            self.dissolved.push(group);
        }
        if place == 0 { Departure::Heir(heir) } else { Departure::Duplicate }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_place_is_handed_on_until_one_point_is_left() {
        let mut same = Coincidences::default();
        assert_eq!(same.leave(3), Departure::Vertex);
        same.join(7, 3);
        same.join(5, 3);
        assert_eq!([3, 5, 7, 9].map(|p| same.vertex(p)), [3, 3, 3, 9]);
        assert_eq!(same.duplicate_count(), 2);
        assert_eq!(same.leave(7), Departure::Duplicate);
        assert_eq!(same.leave(3), Departure::Heir(5));
        assert_eq!(same.vertex(5), 5);
        assert_eq!(same.duplicate_count(), 0);
        assert_eq!(same.leave(5), Departure::Vertex);
        same.join(1, 0);
        assert_eq!(same.groups.len(), 1, "groups are recycled");
        assert_eq!(same.members(0), [0, 1]);
    }
}

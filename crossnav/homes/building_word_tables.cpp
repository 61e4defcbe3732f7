// SPDX-License-Identifier: MIT
// Languages: English, German, French, Spanish, Italian, Dutch, Portuguese, Danish, Swedish,
// Norwegian, Finnish, Polish, Czech, Russian, Chinese, Japanese.
#include "crossnav/homes/building_word_tables.h"

namespace crossnav::homes {
namespace {

// clang-format off
// Types of IFC ("TOILETPAN"), then words.
constexpr ThingWord kThings[] = {
    {"toiletpan", "toilet"}, {"wcseat", "toilet"}, {"urinal", "urinal"}, {"cistern", "cistern"},
    {"washhandbasin", "sink"}, {"sanitaryfountain", "sink"}, {"bath", "bathtub"}, {"bidet", "bidet"},
    {"display", "tv"}, {"television", "tv"}, {"filecabinet", "cabinet"}, {"technicalcabinet", "cabinet"},
    {"electriccooker", "stove"}, {"freestandingelectricheater", "radiator"}, {"dishwasher", "dishwasher"},
    {"fridge freezer", "refrigerator"}, {"washingmachine", "washing machine"}, {"tumbledryer", "dryer"},
    // chair
    {"chair", "chair"}, {"armchair", "armchair"}, {"arm chair", "armchair"}, {"recliner", "recliner"},
    {"office chair", "office chair"}, {"desk chair", "office chair"}, {"task chair", "office chair"},
    {"chair task", "office chair"}, {"chair executive", "office chair"}, {"dining chair", "dining chair"},
    {"chair dining", "dining chair"}, {"table chair", "chair"}, {"wheel chair", "wheelchair"},
    {"wheelchair", "wheelchair"}, {"stuhl", "chair"}, {"stuhle", "chair"}, {"sessel", "armchair"},
    {"lehnstuhl", "armchair"}, {"burostuhl", "office chair"}, {"drehstuhl", "office chair"},
    {"buerostuhl", "office chair"}, {"rollstuhl", "wheelchair"}, {"chaise", "chair"},
    {"chaise de bureau", "office chair"}, {"fauteuil", "armchair"}, {"fauteuil roulant", "wheelchair"},
    {"silla", "chair"}, {"sillon", "armchair"}, {"butaca", "armchair"}, {"silla de oficina", "office chair"},
    {"sedia", "chair"}, {"sedie", "chair"}, {"poltrona", "armchair"}, {"stoel", "chair"},
    {"bureaustoel", "office chair"}, {"leunstoel", "armchair"}, {"cadeira", "chair"}, {"stol", "chair"},
    {"stolar", "chair"}, {"fatolj", "armchair"}, {"laenestol", "armchair"}, {"lenestol", "armchair"},
    {"tuoli", "chair"}, {"nojatuoli", "armchair"}, {"krzeslo", "chair"}, {"fotel", "armchair"},
    {"zidle", "chair"}, {"kreslo", "armchair"}, {"стул", "chair"}, {"кресло", "armchair"},
    {"椅", "chair"}, {"イス", "chair"}, {"チェア", "chair"},
    // what is no chair
    {"stool", "stool"}, {"bar stool", "stool"}, {"bar chair stool", "stool"}, {"hocker", "stool"},
    {"tabouret", "stool"}, {"taburete", "stool"}, {"sgabello", "stool"}, {"kruk", "stool"},
    {"banco", "bench"}, {"bench", "bench"}, {"sitzbank", "bench"}, {"ottoman", "ottoman"}, {"pouf", "ottoman"},
    // sofa
    {"sofa", "sofa"}, {"couch", "couch"}, {"settee", "sofa"}, {"loveseat", "sofa"}, {"love seat", "sofa"},
    {"sofa corner", "corner sofa"}, {"corner sofa", "corner sofa"}, {"ecksofa", "corner sofa"},
    {"schlafsofa", "sofa"}, {"sofa bed", "sofa"}, {"canape", "sofa"}, {"divano", "sofa"}, {"divan", "sofa"},
    {"bankstel", "sofa"}, {"soffa", "sofa"}, {"sohva", "sofa"}, {"kanapa", "sofa"}, {"pohovka", "sofa"},
    {"диван", "sofa"}, {"沙发", "sofa"}, {"ソファ", "sofa"}, {"sofa table", "coffee table"},
    // bed
    {"bed", "bed"}, {"double bed", "double bed"}, {"single bed", "single bed"}, {"bunk bed", "bunk bed"},
    {"bed double", "double bed"}, {"bed single", "single bed"}, {"bed standard", "bed"}, {"crib", "crib"},
    {"bett", "bed"}, {"doppelbett", "double bed"}, {"einzelbett", "single bed"}, {"kinderbett", "kids bed"},
    {"etagenbett", "bunk bed"}, {"hochbett", "loft bed"}, {"lit", "bed"}, {"cama", "bed"}, {"letto", "bed"},
    {"letti", "bed"}, {"sang", "bed"}, {"seng", "bed"}, {"sanky", "bed"}, {"lozko", "bed"}, {"postel", "bed"},
    {"кровать", "bed"}, {"床", "bed"}, {"ベッド", "bed"}, {"flower bed", "flower box"},
    {"bedside table", "bedside table"}, {"table bedside", "bedside table"}, {"night stand", "nightstand"},
    {"nightstand", "nightstand"}, {"nachttisch", "nightstand"}, {"table de nuit", "nightstand"},
    {"table de chevet", "nightstand"}, {"mesita de noche", "nightstand"}, {"comodino", "nightstand"},
    {"nachtkastje", "nightstand"}, {"bed frame drawer", "chest of drawers"},
    // plant
    {"plant", "potted plant"}, {"potted plant", "potted plant"}, {"planting", "potted plant"},
    {"pflanze", "potted plant"}, {"zimmerpflanze", "potted plant"}, {"topfpflanze", "potted plant"},
    {"plante", "potted plant"}, {"planta", "potted plant"}, {"pianta", "potted plant"},
    {"vaxt", "potted plant"}, {"kasvi", "potted plant"}, {"roslina", "potted plant"},
    {"rostlina", "potted plant"}, {"растение", "potted plant"}, {"植物", "potted plant"},
    {"flowers", "flowers"}, {"blumen", "flowers"}, {"planter", "planter"}, {"pot plant", "potted plant"},
    // toilet
    {"toilet", "toilet"}, {"wc", "toilet"}, {"water closet", "toilet"}, {"toilette", "toilet"},
    {"klosett", "toilet"}, {"hange wc", "toilet"}, {"inodoro", "toilet"}, {"vaso sanitario", "toilet"},
    {"vater", "toilet"}, {"toalett", "toilet"}, {"toiletti", "toilet"}, {"wc istuin", "toilet"},
    {"sanita", "toilet"}, {"muszla", "toilet"}, {"унитаз", "toilet"}, {"便器", "toilet"}, {"马桶", "toilet"},
    {"toilet paper", "toilet paper"}, {"paper holder", "toilet paper"}, {"toilet roll", "toilet paper"},
    {"toilet brush", "toilet brush"}, {"toilet partition", "partition"}, {"partition", "partition"},
    // tv
    {"tv", "tv"}, {"flat screen", "tv"}, {"televisor", "tv"}, {"televisore", "tv"}, {"televisie", "tv"},
    {"fernseher", "tv"}, {"televiseur", "tv"}, {"televisio", "tv"}, {"telewizor", "tv"}, {"televize", "tv"},
    {"телевизор", "tv"}, {"电视", "tv"}, {"テレビ", "tv"}, {"tv stand", "tv stand"}, {"tv unit", "tv stand"},
    {"tv cabinet", "tv stand"}, {"tv table", "tv stand"}, {"tv bank", "tv stand"}, {"tv mobel", "tv stand"},
    {"meuble tv", "tv stand"}, {"mueble tv", "tv stand"}, {"monitor", "computer monitor"},
    // other furniture
    {"table", "table"}, {"coffee table", "coffee table"}, {"table coffee", "coffee table"},
    {"dining table", "dining table"}, {"table dining", "dining table"}, {"tisch", "table"},
    {"esstisch", "dining table"}, {"couchtisch", "coffee table"}, {"table basse", "coffee table"},
    {"mesa", "table"}, {"tavolo", "table"}, {"tafel", "table"}, {"bord", "table"}, {"poyta", "table"},
    {"stul", "table"}, {"стол", "table"}, {"桌", "table"}, {"table lamp", "table lamp"},
    {"desk", "desk"}, {"schreibtisch", "desk"}, {"bureau", "desk"}, {"escritorio", "desk"},
    {"scrivania", "desk"}, {"skrivbord", "desk"}, {"skrivebord", "desk"}, {"biurko", "desk"},
    {"cabinet", "cabinet"}, {"base cabinet", "kitchen lower cabinet"},
    {"upper cabinet", "kitchen upper cabinet"}, {"wall cabinet", "kitchen upper cabinet"},
    {"counter top", "counter"}, {"counter", "counter"}, {"countertop", "counter"},
    {"kitchen cabinet", "kitchen lower cabinet"}, {"oberschrank", "kitchen upper cabinet"},
    {"unterschrank", "kitchen lower cabinet"}, {"wardrobe", "wardrobe"}, {"kleiderschrank", "wardrobe"},
    {"schrank", "cabinet"}, {"kommode", "chest of drawers"}, {"dresser", "dresser"},
    {"armoire", "wardrobe"}, {"placard", "cabinet"}, {"armario", "wardrobe"}, {"armadio", "wardrobe"},
    {"kast", "cabinet"}, {"garderob", "wardrobe"}, {"kaappi", "cabinet"}, {"szafa", "wardrobe"},
    {"shelf", "shelf"}, {"shelves", "shelf"}, {"shelving", "shelf"}, {"regal", "shelf"},
    {"etagere", "shelf"}, {"bookcase", "bookshelf"}, {"bookshelf", "bookshelf"},
    {"bucherregal", "bookshelf"}, {"bibliotheque", "bookshelf"}, {"libreria", "bookshelf"},
    {"sink", "sink"}, {"basin", "sink"}, {"lavatory", "sink"}, {"washbasin", "sink"}, {"lavabo", "sink"},
    {"waschtisch", "sink"}, {"waschbecken", "sink"}, {"spule", "sink"}, {"evier", "sink"},
    {"lavandino", "sink"}, {"wastafel", "sink"}, {"fregadero", "sink"}, {"umywalka", "sink"},
    {"vanity", "bathroom cabinet"}, {"vanity cabinet", "bathroom cabinet"}, {"bathtub", "bathtub"},
    {"bath tub", "bathtub"}, {"tub", "bathtub"}, {"badewanne", "bathtub"}, {"baignoire", "bathtub"},
    {"banera", "bathtub"}, {"vasca", "bathtub"}, {"bad", "bathtub"}, {"badkar", "bathtub"},
    {"shower", "shower"}, {"dusche", "shower"}, {"douche", "shower"}, {"ducha", "shower"}, {"doccia", "shower"},
    {"stove", "stove"}, {"cooker", "stove"}, {"range", "stove"}, {"herd", "stove"}, {"oven", "oven"},
    {"backofen", "oven"}, {"cooktop", "stove"}, {"kochfeld", "stove"}, {"cuisiniere", "stove"},
    {"refrigerator", "refrigerator"}, {"fridge", "refrigerator"}, {"kuhlschrank", "refrigerator"},
    {"refrigerateur", "refrigerator"}, {"frigo", "refrigerator"}, {"nevera", "refrigerator"},
    {"frigorifero", "refrigerator"}, {"koelkast", "refrigerator"}, {"washer", "washing machine"},
    {"washing machine", "washing machine"}, {"waschmaschine", "washing machine"}, {"dryer", "dryer"},
    {"lamp", "lamp"}, {"floor lamp", "floor lamp"}, {"light", "lamp"}, {"leuchte", "lamp"},
    {"lampe", "lamp"}, {"luminaire", "lamp"}, {"lampada", "lamp"}, {"lampara", "lamp"},
    {"mirror", "mirror"}, {"spiegel", "mirror"}, {"miroir", "mirror"}, {"espejo", "mirror"},
    {"specchio", "mirror"}, {"rug", "rug"}, {"carpet", "rug"}, {"teppich", "rug"}, {"curtain", "curtain"},
    {"radiator", "radiator"}, {"heizkorper", "radiator"}, {"fireplace", "fireplace"}, {"kamin", "fireplace"},
    {"piano", "piano"}, {"picture", "picture"}, {"elevator", "elevator"}, {"lift", "elevator"},
};

constexpr auto kLiving = world::RoomType::kLiving;
constexpr auto kKitchen = world::RoomType::kKitchen;
constexpr auto kDining = world::RoomType::kDining;
constexpr auto kBedroom = world::RoomType::kBedroom;
constexpr auto kBathroom = world::RoomType::kBathroom;
constexpr auto kWc = world::RoomType::kWc;
constexpr auto kOffice = world::RoomType::kOffice;
constexpr auto kHall = world::RoomType::kHall;
constexpr auto kStairwell = world::RoomType::kStairwell;
constexpr auto kStorage = world::RoomType::kStorage;
constexpr auto kGarage = world::RoomType::kGarage;
constexpr auto kBalcony = world::RoomType::kBalcony;

constexpr RoomWord kRooms[] = {
    {"living", kLiving}, {"living room", kLiving}, {"livingroom", kLiving}, {"lounge", kLiving},
    {"family room", kLiving}, {"sitting room", kLiving}, {"great room", kLiving}, {"media room", kLiving},
    {"tv room", kLiving}, {"play room", kLiving}, {"playroom", kLiving}, {"wohnzimmer", kLiving},
    {"wohnen", kLiving}, {"wohnraum", kLiving}, {"wohnkuche", kLiving}, {"wohnbereich", kLiving},
    {"wohn und esszimmer", kLiving}, {"aufenthaltsraum", kLiving}, {"salon", kLiving}, {"sejour", kLiving},
    {"piece de vie", kLiving}, {"sala", kLiving}, {"salon comedor", kLiving}, {"sala de estar", kLiving},
    {"soggiorno", kLiving}, {"salotto", kLiving}, {"woonkamer", kLiving}, {"zitkamer", kLiving},
    {"vardagsrum", kLiving}, {"allrum", kLiving}, {"stue", kLiving}, {"opholdsstue", kLiving},
    {"olohuone", kLiving}, {"pokoj dzienny", kLiving}, {"obyvaci pokoj", kLiving}, {"гостиная", kLiving},
    {"客厅", kLiving}, {"起居室", kLiving}, {"居間", kLiving}, {"リビング", kLiving},
    {"kitchen", kKitchen}, {"kitchenette", kKitchen}, {"kuche", kKitchen}, {"kueche", kKitchen},
    {"kochen", kKitchen}, {"kochnische", kKitchen}, {"teekuche", kKitchen}, {"cuisine", kKitchen},
    {"cocina", kKitchen}, {"cucina", kKitchen}, {"keuken", kKitchen}, {"cozinha", kKitchen}, {"kok", kKitchen},
    {"kokken", kKitchen}, {"kjokken", kKitchen}, {"keittio", kKitchen}, {"kuchnia", kKitchen},
    {"kuchyn", kKitchen}, {"kuchyne", kKitchen}, {"кухня", kKitchen}, {"厨房", kKitchen},
    {"台所", kKitchen}, {"キッチン", kKitchen}, {"pantry kitchen", kKitchen},
    {"dining", kDining}, {"dining room", kDining}, {"breakfast", kDining}, {"esszimmer", kDining},
    {"essen", kDining}, {"essbereich", kDining}, {"salle a manger", kDining}, {"comedor", kDining},
    {"sala da pranzo", kDining}, {"pranzo", kDining}, {"eetkamer", kDining}, {"sala de jantar", kDining},
    {"matsal", kDining}, {"spisestue", kDining}, {"ruokailu", kDining}, {"jadalnia", kDining},
    {"jidelna", kDining}, {"столовая", kDining}, {"餐厅", kDining}, {"食堂", kDining},
    {"bedroom", kBedroom}, {"bed room", kBedroom}, {"guest room", kBedroom}, {"guest", kBedroom},
    {"kids room", kBedroom}, {"child room", kBedroom}, {"children s room", kBedroom}, {"nursery", kBedroom},
    {"master", kBedroom}, {"hotel room", kBedroom}, {"patient room", kBedroom}, {"schlafzimmer", kBedroom},
    {"schlafen", kBedroom}, {"schlafraum", kBedroom}, {"kinderzimmer", kBedroom}, {"kind", kBedroom},
    {"kinder", kBedroom}, {"eltern", kBedroom}, {"elternschlafzimmer", kBedroom}, {"gastezimmer", kBedroom},
    {"gast", kBedroom}, {"gaste", kBedroom}, {"zimmer", kBedroom}, {"individualraum", kBedroom},
    {"chambre", kBedroom}, {"dormitorio", kBedroom}, {"habitacion", kBedroom}, {"recamara", kBedroom},
    {"camera", kBedroom}, {"camera da letto", kBedroom}, {"cameretta", kBedroom}, {"slaapkamer", kBedroom},
    {"quarto", kBedroom}, {"suite", kBedroom}, {"sovrum", kBedroom}, {"barnrum", kBedroom},
    {"sovevaerelse", kBedroom}, {"vaerelse", kBedroom}, {"soverom", kBedroom}, {"makuuhuone", kBedroom},
    {"lastenhuone", kBedroom}, {"sypialnia", kBedroom}, {"loznice", kBedroom}, {"detsky pokoj", kBedroom},
    {"спальня", kBedroom}, {"детская", kBedroom}, {"卧室", kBedroom}, {"寝室", kBedroom}, {"洋室", kBedroom},
    {"bath", kBathroom}, {"bathroom", kBathroom}, {"bath room", kBathroom}, {"shower", kBathroom},
    {"shower room", kBathroom}, {"ensuite", kBathroom}, {"en suite", kBathroom}, {"washroom", kBathroom},
    {"bad", kBathroom}, {"badezimmer", kBathroom}, {"badzimmer", kBathroom}, {"duschbad", kBathroom},
    {"dusche", kBathroom}, {"dusche wc", kBathroom}, {"bad wc", kBathroom}, {"salle de bain", kBathroom},
    {"salle de bains", kBathroom}, {"salle d eau", kBathroom}, {"sdb", kBathroom}, {"bano", kBathroom},
    {"cuarto de bano", kBathroom}, {"bagno", kBathroom}, {"badkamer", kBathroom},
    {"casa de banho", kBathroom}, {"banheiro", kBathroom}, {"badrum", kBathroom}, {"badevaerelse", kBathroom},
    {"baderom", kBathroom}, {"kylpyhuone", kBathroom}, {"lazienka", kBathroom}, {"koupelna", kBathroom},
    {"ванная", kBathroom}, {"санузел", kBathroom}, {"浴室", kBathroom}, {"卫生间", kBathroom},
    {"wc", kWc}, {"toilet", kWc}, {"restroom", kWc}, {"powder room", kWc}, {"half bath", kWc},
    {"lavatory", kWc}, {"cloakroom wc", kWc}, {"toilette", kWc}, {"gaste wc", kWc}, {"toilettes", kWc},
    {"aseo", kWc}, {"toaleta", kWc}, {"toalett", kWc}, {"туалет", kWc}, {"厕所", kWc}, {"トイレ", kWc},
    {"office", kOffice}, {"home office", kOffice}, {"study", kOffice}, {"work room", kOffice},
    {"meeting", kOffice}, {"meeting room", kOffice}, {"conference", kOffice}, {"library", kOffice},
    {"classroom", kOffice}, {"hobby", kOffice}, {"buro", kOffice}, {"buero", kOffice},
    {"arbeitszimmer", kOffice}, {"arbeiten", kOffice}, {"arbeitsraum", kOffice}, {"besprechung", kOffice},
    {"seminarraum", kOffice}, {"bureau", kOffice}, {"despacho", kOffice}, {"oficina", kOffice},
    {"estudio", kOffice}, {"ufficio", kOffice}, {"studio", kOffice}, {"kantoor", kOffice},
    {"werkkamer", kOffice}, {"escritorio", kOffice}, {"kontor", kOffice}, {"arbetsrum", kOffice},
    {"toimisto", kOffice}, {"tyohuone", kOffice}, {"biuro", kOffice}, {"gabinet", kOffice},
    {"kancelar", kOffice}, {"pracovna", kOffice}, {"кабинет", kOffice}, {"офис", kOffice}, {"办公室", kOffice},
    {"书房", kOffice}, {"書斎", kOffice}, {"事務室", kOffice},
    {"hall", kHall}, {"hallway", kHall}, {"foyer", kHall}, {"entry", kHall}, {"entrance", kHall},
    {"entrance hall", kHall}, {"corridor", kHall}, {"lobby", kHall}, {"vestibule", kHall},
    {"circulation", kHall}, {"passage", kHall}, {"landing", kHall}, {"gallery", kHall}, {"flur", kHall},
    {"diele", kHall}, {"gang", kHall}, {"eingang", kHall}, {"windfang", kHall}, {"garderobe", kHall},
    {"galerie", kHall}, {"korridor", kHall}, {"couloir", kHall}, {"entree", kHall}, {"degagement", kHall},
    {"palier", kHall}, {"pasillo", kHall}, {"recibidor", kHall}, {"vestibulo", kHall}, {"corridoio", kHall},
    {"ingresso", kHall}, {"disimpegno", kHall}, {"gangen", kHall}, {"hal", kHall}, {"overloop", kHall},
    {"corredor", kHall}, {"kapprum", kHall}, {"entre", kHall}, {"eteinen", kHall}, {"kaytava", kHall},
    {"korytarz", kHall}, {"przedpokoj", kHall}, {"chodba", kHall}, {"predsin", kHall}, {"коридор", kHall},
    {"прихожая", kHall}, {"холл", kHall}, {"走廊", kHall}, {"玄関", kHall}, {"廊下", kHall}, {"ホール", kHall},
    {"stair", kStairwell}, {"stairs", kStairwell}, {"staircase", kStairwell}, {"stairwell", kStairwell},
    {"stair hall", kStairwell}, {"treppe", kStairwell}, {"treppenhaus", kStairwell}, {"escalier", kStairwell},
    {"cage d escalier", kStairwell}, {"escalera", kStairwell}, {"scala", kStairwell}, {"scale", kStairwell},
    {"trap", kStairwell}, {"trappenhuis", kStairwell}, {"escada", kStairwell}, {"trapphus", kStairwell},
    {"trapperum", kStairwell}, {"trapperom", kStairwell}, {"porras", kStairwell}, {"schody", kStairwell},
    {"klatka schodowa", kStairwell}, {"schodiste", kStairwell}, {"лестница", kStairwell},
    {"楼梯", kStairwell}, {"階段", kStairwell},
    {"storage", kStorage}, {"store", kStorage}, {"store room", kStorage}, {"closet", kStorage},
    {"walk in closet", kStorage}, {"utility", kStorage}, {"laundry", kStorage}, {"pantry", kStorage},
    {"mechanical", kStorage}, {"technical", kStorage}, {"cellar", kStorage}, {"basement", kStorage},
    {"dressing", kStorage}, {"abstellraum", kStorage}, {"abstell", kStorage}, {"abstellkammer", kStorage},
    {"lager", kStorage}, {"keller", kStorage}, {"kellerraum", kStorage}, {"hauswirtschaftsraum", kStorage},
    {"hwr", kStorage}, {"hausanschlussraum", kStorage}, {"technik", kStorage}, {"technikraum", kStorage},
    {"waschkuche", kStorage}, {"speisekammer", kStorage}, {"ankleide", kStorage}, {"kammer", kStorage},
    {"cellier", kStorage}, {"rangement", kStorage}, {"buanderie", kStorage}, {"cave", kStorage},
    {"debarras", kStorage}, {"trastero", kStorage}, {"lavadero", kStorage}, {"despensa", kStorage},
    {"ripostiglio", kStorage}, {"cantina", kStorage}, {"lavanderia", kStorage}, {"deposito", kStorage},
    {"berging", kStorage}, {"arrumos", kStorage}, {"forrad", kStorage}, {"bryggers", kStorage},
    {"bod", kStorage}, {"varasto", kStorage}, {"kodinhoitohuone", kStorage}, {"magazyn", kStorage},
    {"spizarnia", kStorage}, {"pralnia", kStorage}, {"sklad", kStorage}, {"spiz", kStorage},
    {"кладовая", kStorage}, {"储藏", kStorage}, {"納戸", kStorage}, {"収納", kStorage},
    {"garage", kGarage}, {"car port", kGarage}, {"carport", kGarage}, {"parking", kGarage},
    {"workshop", kGarage}, {"werkstatt", kGarage}, {"garaje", kGarage}, {"atelier", kGarage},
    {"garaz", kGarage}, {"autotalli", kGarage}, {"гараж", kGarage}, {"车库", kGarage}, {"車庫", kGarage},
    {"balcony", kBalcony}, {"terrace", kBalcony}, {"patio", kBalcony}, {"porch", kBalcony},
    {"deck", kBalcony}, {"loggia", kBalcony}, {"balkon", kBalcony}, {"terrasse", kBalcony},
    {"balcon", kBalcony}, {"terraza", kBalcony}, {"balcone", kBalcony}, {"terrazzo", kBalcony},
    {"terras", kBalcony}, {"varanda", kBalcony}, {"balkong", kBalcony}, {"altan", kBalcony},
    {"parveke", kBalcony}, {"taras", kBalcony}, {"балкон", kBalcony}, {"阳台", kBalcony}, {"バルコニー", kBalcony},
};

constexpr ThingWord kNoRooms[] = {
    {"roof", ""}, {"dach", ""}, {"dachflache", ""}, {"toit", ""}, {"toiture", ""}, {"cubierta", ""},
    {"tejado", ""}, {"tetto", ""}, {"copertura", ""}, {"dak", ""}, {"telhado", ""}, {"tak", ""},
    {"katto", ""}, {"strecha", ""}, {"крыша", ""}, {"shaft", ""}, {"schacht", ""},
    {"plenum", ""}, {"void", ""}, {"luftraum", ""}, {"vide", ""}, {"site", ""}, {"garden", ""},
    {"garten", ""}, {"jardin", ""}, {"gross area", ""}, {"gross floor area", ""}, {"bgf", ""},
};
// clang-format on

}  // namespace

std::span<const ThingWord> ThingWords() {
  return kThings;
}
std::span<const RoomWord> RoomWords() {
  return kRooms;
}
std::span<const ThingWord> NoRoomWords() {
  return kNoRooms;
}

}  // namespace crossnav::homes
